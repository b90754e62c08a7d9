#!/usr/bin/env python3
"""Every configuration that the package ships can be used."""

import glob
import os
import signal
import subprocess
import unittest

import rospkg
import rospy
import rostest
import yaml
from live_support import program, wait_for

PACKAGE = rospkg.RosPack().get_path('scan_image_slam')
NODES = ('scan_image_fusion', 'bounded_icp', 'mapper')


class ConfigurationsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('configurations_test')

    def test_every_yaml_loads(self):
        files = glob.glob(os.path.join(PACKAGE, 'config', '**', '*.yaml'), recursive=True)
        self.assertGreaterEqual(len(files), 5)
        for path in files + glob.glob(os.path.join(PACKAGE, 'rviz', '*.rviz')):
            with self.subTest(path), open(path) as file:
                self.assertIsInstance(yaml.safe_load(file), dict)

    def test_the_nodes_accept_every_configuration(self):
        for path in sorted(glob.glob(os.path.join(PACKAGE, 'config', '*.yaml'))):
            space = '/' + os.path.basename(path)[:-len('.yaml')]
            with open(path) as file:
                parameters = yaml.safe_load(file)
            rospy.set_param(space, parameters)
            self.assertLessEqual(set(parameters), set(NODES))
            for node in NODES:
                with self.subTest(path=path, node=node):
                    self.expect_up_and_down(node, space)

    def expect_up_and_down(self, node, space):
        process = subprocess.Popen([program(node), '__ns:=' + space], stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT, text=True)

        def is_up():
            if process.poll() is not None:
                return True
            publishers = rospy.get_master().getSystemState()[2][0]
            return any(f'{space}/{node}' in nodes for topic, nodes in publishers
                       if topic != '/rosout')
        try:
            wait_for(is_up, 'the node ' + node)
        finally:
            process.send_signal(signal.SIGINT)
            output, _ = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 0, output)


if __name__ == '__main__':
    rostest.rosrun('scan_image_slam', 'configurations', ConfigurationsTest)
