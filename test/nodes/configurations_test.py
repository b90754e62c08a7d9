#!/usr/bin/env python3
"""Every configuration that the package ships can be used."""

import glob
import os
import unittest

import rospkg
import rospy
import rostest
import yaml
from live_support import expect_up_and_down

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
                    expect_up_and_down(f'{space}/{node}')


if __name__ == '__main__':
    rostest.rosrun('scan_image_slam', 'configurations', ConfigurationsTest)
