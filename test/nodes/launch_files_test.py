#!/usr/bin/env python3
"""Every launch file and every configuration that the package ships can be used."""

import glob
import itertools
import os
import signal
import subprocess
import unittest

import roslaunch
import roslib.packages
import rospkg
import rospy
import rostest
import yaml
from live_support import program, wait_for

PACKAGE = rospkg.RosPack().get_path('scan_image_slam')
NODES = ('scan_image_fusion', 'bounded_icp', 'mapper')
BOOLEANS = ('true', 'false')


def load(name, **arguments):
    """What roslaunch would start, and with which parameters."""
    path = os.path.join(PACKAGE, 'launch', name)
    words = [f'{key}:={value}' for key, value in arguments.items()]
    return roslaunch.config.load_config_default([(path, words)], None, verbose=False)


def types(config):
    return {(node.package, node.type) for node in config.nodes}


def value(config, name):
    return config.params[name].value


class LaunchFilesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('launch_files_test')

    def expect_programs(self, config):
        self.assertTrue(config.nodes)
        self.assertFalse(config.config_errors)
        for node in config.nodes:
            self.assertTrue(roslib.packages.find_node(node.package, node.type),
                            f'{node.package} has no program {node.type}')
            for word in node.args.split():
                if word.startswith('/') and word.endswith('.rviz'):
                    self.assertTrue(os.path.isfile(word), word)

    def test_every_file_with_its_defaults(self):
        files = sorted(glob.glob(os.path.join(PACKAGE, 'launch', '*.launch')))
        self.assertGreaterEqual(len(files), 3)
        for path in files:
            with self.subTest(os.path.basename(path)):
                name = os.path.basename(path)
                self.expect_programs(load(name, **({'bag': '/a.bag'} if 'bag' in name else {})))

    def test_slam(self):
        for config, camera, rviz in itertools.product(('default', 'paper'), BOOLEANS, BOOLEANS):
            with self.subTest(config=config, camera=camera, rviz=rviz):
                loaded = load('slam.launch', config=config, use_camera=camera, rviz=rviz)
                self.expect_programs(loaded)
                self.assertTrue({('scan_image_slam', n) for n in NODES} <= types(loaded))
                self.assertEqual(('rviz', 'rviz') in types(loaded), rviz == 'true')
                self.assertEqual(value(loaded, '/scan_image_fusion/use_camera'), camera == 'true')
                self.assertEqual(value(loaded, '/bounded_icp/reference'),
                                 'local_map' if config == 'default' else 'previous_frame')

    def test_slam_hands_topics_and_frames_to_the_nodes(self):
        loaded = load('slam.launch', scan_topic='front/scan', image_topic='cam/image',
                      camera_info_topic='cam/info', odom_topic='wheel_odom', map_frame='world',
                      base_frame='base_footprint', odom_frame='wheels', odom_source='topic',
                      image_transport='compressed')
        remaps = {node.name: dict(node.remap_args) for node in loaded.nodes}
        fusion = {key.lstrip('/'): to.lstrip('/')
                  for key, to in remaps['scan_image_fusion'].items()}
        self.assertEqual(fusion, {'scan': 'front/scan', 'image_raw': 'cam/image',
                                  'image_raw/compressed': 'cam/image/compressed',
                                  'camera_info': 'cam/info', 'odom': 'wheel_odom'})
        icp = {key.lstrip('/'): to.lstrip('/') for key, to in remaps['bounded_icp'].items()}
        self.assertEqual(icp, {'odom': 'wheel_odom'})
        for node in NODES:
            self.assertEqual(value(loaded, f'/{node}/base_frame'), 'base_footprint')
            self.assertEqual(value(loaded, f'/{node}/odom_frame'), 'wheels')
        self.assertEqual(value(loaded, '/mapper/map_frame'), 'world')
        self.assertEqual(value(loaded, '/scan_image_fusion/image_transport'), 'compressed')
        self.assertEqual(value(loaded, '/bounded_icp/odom_source'), 'topic')

    def test_slam_with_a_saved_map(self):
        loaded = load('slam.launch', state='office.state', localization='true')
        self.assertEqual(value(loaded, '/mapper/state_file'), 'office.state')
        self.assertEqual(value(loaded, '/mapper/localization'), True)
        self.assertFalse(next(n for n in loaded.nodes if n.name == 'mapper').respawn)
        saving = load('slam.launch', state='office.state', autosave='60')
        self.assertEqual(value(saving, '/mapper/autosave_period'), 60)
        self.assertTrue(next(n for n in saving.nodes if n.name == 'mapper').respawn)
        played = load('bag.launch', bag='/a.bag', state='/b.state', localization='true')
        self.assertEqual(value(played, '/mapper/state_file'), '/b.state')
        self.assertEqual(value(played, '/mapper/localization'), True)

    def test_slam_takes_the_path_of_a_configuration(self):
        path = os.path.join(PACKAGE, 'config', 'paper.yaml')
        self.assertEqual(value(load('slam.launch', config=path), '/bounded_icp/reference'),
                         'previous_frame')

    def test_simulation(self):
        for world in sorted(glob.glob(os.path.join(PACKAGE, 'config', 'worlds', '*.yaml'))):
            name = os.path.basename(world)[:-len('.yaml')]
            loaded = load('simulation.launch', world=name, use_camera='false', record='/a',
                          map_folder='/b')
            self.expect_programs(loaded)
            self.assertEqual(value(loaded, '/robot_simulator/world'), name)
            self.assertEqual(value(loaded, '/robot_simulator/images'), False)
            self.assertEqual(value(loaded, '/trajectory_recorder/folder'), '/a')
            self.assertEqual(value(loaded, '/mapper/map_folder'), '/b')

    def test_bag(self):
        loaded = load('bag.launch', bag='/a b.bag', rate='2.0', rviz='false', loop='true')
        self.expect_programs(loaded)
        self.assertEqual(value(loaded, '/use_sim_time'), True)
        player = next(node for node in loaded.nodes if node.name == 'player')
        for word in ('--clock', '--rate 2.0', '--loop', '/a b.bag'):
            self.assertIn(word, player.args)
        once = next(node for node in load('bag.launch', bag='/a.bag').nodes
                    if node.name == 'player')
        self.assertNotIn('--loop', once.args)

    def test_an_unknown_configuration_is_an_error(self):
        with self.assertRaises(roslaunch.RLException):
            load('slam.launch', config='no_such')

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
    rostest.rosrun('scan_image_slam', 'launch_files', LaunchFilesTest)
