#!/usr/bin/env python3
"""A node with a wrong parameter ends at once, with an exit code and the parameter's full name."""

import subprocess
import unittest

import rospy
import rostest
from live_support import expect_up_and_down, program

NODES = ('scan_image_fusion', 'bounded_icp', 'mapper')


class WrongParametersTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('wrong_parameters_test')

    def set_private(self, name, parameters):
        """Gives the node these private parameters and no others."""
        for key in rospy.get_param_names():
            if key.startswith(name + '/'):
                rospy.delete_param(key)
        for key, value in parameters.items():
            rospy.set_param(f'{name}/{key}', value)

    def expect_end(self, node, parameters, *words, name=None):
        name = name or '/' + node
        self.set_private(name, parameters)
        namespace, _, base = name.rpartition('/')
        process = subprocess.run([program(node), '__name:=' + base, '__ns:=' + (namespace or '/')],
                                 stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                 timeout=60)
        self.assertEqual(process.returncode, 1, process.stdout)
        for word in words:
            self.assertIn(word, process.stdout)

    def expect_running(self, node, parameters, *arguments):
        """The node comes up and ends in order when it is told to; gives what it said."""
        self.set_private('/' + node, parameters)
        return expect_up_and_down('/' + node, *arguments)

    def test_unknown(self):
        self.expect_end('scan_image_fusion', {'min_rnage': 0.2},
                        '/scan_image_fusion/min_rnage: unknown parameter', 'did you mean min_range')
        self.expect_end('bounded_icp', {'window/min_distnace': 0.2},
                        '/bounded_icp/window/min_distnace: unknown', 'window/min_distance')
        self.expect_end('mapper', {'alpha': 0.2}, '/mapper/alpha: unknown parameter')

    def test_names_of_other_packages_are_answered_with_ours(self):
        output = self.expect_running('mapper', {'delta': 0.2, 'particles': 30, 'map_size': 2048})
        self.assertIn('/mapper/delta: a parameter of gmapping, not used; use mapper/resolution',
                      output)
        self.assertIn('/mapper/particles: a parameter of gmapping, not used; there is nothing',
                      output)
        self.assertIn('/mapper/map_size: a parameter of hector_mapping', output)
        output = self.expect_running('scan_image_fusion', {'maxUrange': 8.0})
        self.assertIn('use mapper/map_max_range and scan_image_fusion/max_range', output)

    def test_mistyped(self):
        self.expect_end('scan_image_fusion', {'use_camera': 'yes please'},
                        '/scan_image_fusion/use_camera', 'of type string, expected is bool')
        self.expect_end('bounded_icp', {'local_map/insert_first': 0.5},
                        '/bounded_icp/local_map/insert_first', 'of type double, expected is int')
        self.expect_end('mapper', {'resolution': [0.05, 0.05]},
                        '/mapper/resolution: a single value is expected')

    def test_out_of_range(self):
        self.expect_end('scan_image_fusion', {'max_image_age': -1.0},
                        '/scan_image_fusion/max_image_age: -1.0 is out of range')
        self.expect_end('bounded_icp', {'reference': 'next_frame'},
                        '/bounded_icp/reference: "next_frame" is not one of', 'previous_frame')
        self.expect_end('mapper', {'resolution': 0.0}, '/mapper/resolution: 0.0 is out of range')

    def test_parameters_that_do_not_fit_each_other(self):
        self.expect_end('scan_image_fusion', {'min_range': 2.0, 'max_range': 1.0},
                        '/scan_image_fusion/max_range must be greater than min_range')
        self.expect_end('mapper', {'localization': True},
                        'mapper/localization: needs mapper/state_file')
        self.expect_end('mapper', {'autosave_period': 60.0},
                        'mapper/autosave_period: needs mapper/state_file')
        self.expect_end('mapper', {'localization': True, 'state_file': '/none/at.all'},
                        '/none/at.all: No such file')

    def test_the_full_name_has_the_namespace(self):
        self.expect_end('mapper', {'reslution': 0.1}, '/robot1/cartographer/reslution: unknown',
                        name='/robot1/cartographer')

    def test_an_unknown_transport_of_images(self):
        self.expect_end('scan_image_fusion', {'image_transport': 'pigeon'},
                        '/scan_image_fusion/image_transport', 'pigeon')

    def test_what_libraries_keep_below_the_name_of_a_node_is_left_alone(self):
        self.expect_running('scan_image_fusion',
                            {'mode': 'unchanged', 'post_processing_level': 0,
                             'diagnostic_period': 2.0, 'image/compressed/jpeg_quality': 80,
                             'image/compressed/format': 'jpeg', 'image/theora/quality': 31,
                             'image/disable_pub_plugins': ['image_transport/theora']},
                            'fusion/image:=/scan_image_fusion/image')

    def test_nodes_run_with_no_parameters_at_all(self):
        for node in NODES:
            with self.subTest(node):
                self.expect_running(node, {})

    def test_the_simulator(self):
        self.expect_end('robot_simulator', {'world': 'moon'}, 'moon')
        self.expect_end('robot_simulator', {'path': 'home'}, 'home')


if __name__ == '__main__':
    rostest.rosrun('scan_image_slam', 'wrong_parameters', WrongParametersTest)
