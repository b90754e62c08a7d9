#!/usr/bin/env python3
"""Every launch file that the package ships can be used."""

import glob
import itertools
import os
import shutil
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree

import roslaunch
import roslib.packages
import rospkg
import rospy
import rostest
from launch_support import PACKAGE, load, remaps, stand_in, types, value
from live_support import program

NODES = ('scan_image_fusion', 'bounded_icp', 'mapper')
BOOLEANS = ('true', 'false')
# Packages that are not installed everywhere, and their programs.
DRIVERS = {'urg_node': 'urg_node', 'usb_cam': 'usb_cam_node', 'compressed_image_transport': None}


class LaunchFilesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('launch_files_test')
        cls.folder = tempfile.mkdtemp()
        cls.installed = dict(os.environ)
        for package, program in DRIVERS.items():
            stand_in(cls.folder, package, program)
        os.environ['ROS_PACKAGE_PATH'] += os.pathsep + cls.folder

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

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
        self.assertGreaterEqual(len(files), 6)
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
                      image_transport='compressed', rviz='true')
        self.assertEqual(next(n.args for n in loaded.nodes if n.type == 'rviz')[-9:], ' -f world')
        self.assertEqual(remaps(loaded, 'scan_image_fusion'), {'scan': 'front/scan', 'image_raw': 'cam/image',
                                  'image_raw/compressed': 'cam/image/compressed',
                                  'camera_info': 'cam/info', 'odom': 'wheel_odom'})
        self.assertEqual(remaps(loaded, 'bounded_icp'), {'odom': 'wheel_odom'})
        for node in NODES:
            self.assertEqual(value(loaded, f'/{node}/base_frame'), 'base_footprint')
            self.assertEqual(value(loaded, f'/{node}/odom_frame'), 'wheels')
        self.assertEqual(value(loaded, '/mapper/map_frame'), 'world')
        self.assertEqual(value(loaded, '/scan_image_fusion/image_transport'), 'compressed')
        self.assertEqual(value(loaded, '/bounded_icp/odom_source'), 'topic')

    def test_slam_with_nodelets_of_a_manager_of_its_own(self):
        loaded = load('slam.launch', nodelets='true', scan_topic='front/scan')
        self.expect_programs(loaded)
        nodes = {node.name: node for node in loaded.nodes}
        self.assertEqual(nodes.pop('scan_image_slam_manager').args, 'manager')
        self.assertEqual({name: node.args for name, node in nodes.items()}, {
            name: f'load scan_image_slam/{nodelet} scan_image_slam_manager'
            for name, nodelet in zip(NODES, ('ScanImageFusionNodelet', 'BoundedIcpNodelet',
                                             'MapperNodelet'))})
        self.assertEqual(types(loaded), {('nodelet', 'nodelet')})
        remaps = dict(nodes['scan_image_fusion'].remap_args)
        self.assertEqual(remaps[next(key for key in remaps if key.endswith('scan'))].lstrip('/'),
                         'front/scan')
        self.assertEqual(value(loaded, '/mapper/base_frame'), 'base_link')

    def test_slam_with_nodelets_of_a_manager_that_runs_already(self):
        loaded = load('slam.launch', nodelets='true', manager='camera/manager')
        self.assertEqual({node.name for node in loaded.nodes}, set(NODES))
        for node in loaded.nodes:
            self.assertEqual(node.args.split()[0], 'load')
            self.assertEqual(node.args.split()[-1], 'camera/manager')

    def test_slam_with_a_saved_map(self):
        loaded = load('slam.launch', state='office.state', localization='true')
        self.assertEqual(value(loaded, '/mapper/state_file'), 'office.state')
        self.assertEqual(value(loaded, '/mapper/localization'), True)
        self.assertFalse(next(n for n in loaded.nodes if n.name == 'mapper').respawn)
        saving = load('slam.launch', state='office.state', autosave='60')
        self.assertEqual(value(saving, '/mapper/autosave_period'), 60)
        self.assertTrue(next(n for n in saving.nodes if n.name == 'mapper').respawn)

    def test_every_way_to_start_takes_a_saved_map(self):
        for name, arguments in (('bag.launch', {'bag': '/a.bag'}), ('robot.launch', {}),
                                ('tetra_ds3.launch', {}), ('simulation.launch', {})):
            with self.subTest(name):
                loaded = load(name, state='/b.state', localization='true', **arguments)
                self.assertEqual(value(loaded, '/mapper/state_file'), '/b.state')
                self.assertEqual(value(loaded, '/mapper/localization'), True)
                if name != 'bag.launch':
                    saving = load(name, autosave='60', **arguments)
                    self.assertEqual(value(saving, '/mapper/autosave_period'), 60)

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

    def test_robot_hands_its_arguments_on(self):
        loaded = load('robot.launch', config='paper', scan_topic='front/scan', odom_topic='wheels',
                      base_frame='base_footprint', use_camera='false', rviz='true')
        self.expect_programs(loaded)
        self.assertIn(('rviz', 'rviz'), types(loaded))
        self.assertEqual(remaps(loaded, 'scan_image_fusion')['scan'], 'front/scan')
        self.assertEqual(remaps(loaded, 'bounded_icp')['odom'], 'wheels')
        self.assertEqual(value(loaded, '/mapper/base_frame'), 'base_footprint')
        self.assertEqual(value(loaded, '/scan_image_fusion/use_camera'), False)
        self.assertEqual(value(loaded, '/bounded_icp/reference'), 'previous_frame')

    def test_two_sides_make_one_robot(self):
        arguments = {'config': 'paper', 'base_frame': 'base_footprint', 'map_frame': 'world'}
        robot = load('robot_side.launch', scan_topic='front/scan', **arguments)
        base = load('base_side.launch', base_frame='base_footprint', map_frame='world',
                    rviz='false', autosave='60', state='/a.state')
        whole = load('robot.launch', scan_topic='front/scan', **arguments)
        self.assertEqual([node.name for node in robot.nodes], ['scan_image_fusion', 'bounded_icp'])
        self.assertEqual([node.name for node in base.nodes], ['mapper'])
        for node in NODES[:2]:
            self.assertEqual(remaps(robot, node), remaps(whole, node))
        # The master holds the parameters of both, in whichever order they are started.
        here = {name: param.value for name, param in robot.params.items()}
        there = {name: param.value for name, param in base.params.items()}
        one = {name: param.value for name, param in whole.params.items()}
        for together in ({**here, **there}, {**there, **here}):
            for name, expected in one.items():
                if name not in ('/rosdistro', '/rosversion', '/run_id', '/mapper/state_file',
                                '/mapper/autosave_period'):
                    self.assertEqual(together[name], expected, name)
        self.assertEqual(there['/mapper/state_file'], '/a.state')
        self.assertEqual(there['/mapper/autosave_period'], 60)
        self.assertTrue(all(node.respawn for node in robot.nodes + base.nodes))
        self.assertFalse([name for name in there if 'fusion' in name or 'icp' in name])
        self.assertIn(('rviz', 'rviz'), types(load('base_side.launch')))

    def test_mounts_are_published_on_robots_only(self):
        for name, arguments, published in (
                ('robot.launch', {}, True), ('robot.launch', {'publish_mounts': 'false'}, False),
                ('slam.launch', {}, False), ('bag.launch', {'bag': '/a.bag'}, False)):
            with self.subTest(name=name, **arguments):
                self.assertEqual(value(load(name, **arguments),
                                       '/scan_image_fusion/publish_mounts'), published)

    def drivers_file(self):
        path = os.path.join(self.folder, 'drivers.launch')
        with open(path, 'w') as file:
            file.write('<launch><node pkg="usb_cam" type="usb_cam_node" name="mine"/></launch>')
        return path

    def test_drivers_of_ones_own(self):
        for name, argument in (('robot.launch', 'drivers'), ('tetra_ds3.launch', 'base_launch')):
            with self.subTest(name):
                loaded = load(name, **{argument: self.drivers_file()})
                self.expect_programs(loaded)
                self.assertIn('mine', {node.name for node in loaded.nodes})

    def test_tetra(self):
        loaded = load('tetra_ds3.launch', laser_address='10.0.0.7', laser_frame='hokuyo',
                      camera_device='/dev/video3', camera_frame='eye', odom_topic='wheels')
        self.expect_programs(loaded)
        self.assertEqual({node.name for node in loaded.nodes}, {'laser', 'camera', *NODES})
        self.assertEqual(value(loaded, '/laser/ip_address'), '10.0.0.7')
        self.assertEqual(value(loaded, '/laser/frame_id'), 'hokuyo')
        # All 270 degrees of the laser, in radians.
        self.assertAlmostEqual(value(loaded, '/laser/angle_min'), -2.356194, 6)
        self.assertAlmostEqual(value(loaded, '/laser/angle_max'), 2.356194, 6)
        self.assertEqual(value(loaded, '/laser/synchronize_time'), True)
        self.assertEqual(value(loaded, '/camera/video_device'), '/dev/video3')
        self.assertEqual(value(loaded, '/camera/camera_frame_id'), 'eye')
        self.assertEqual(value(loaded, '/camera/autoexposure'), False)
        # What the drivers publish is what the nodes read.
        fusion = remaps(loaded, 'scan_image_fusion')
        self.assertEqual(fusion['image_raw'], 'camera/image_raw')
        self.assertEqual(fusion['camera_info'], 'camera/camera_info')
        self.assertEqual(remaps(loaded, 'laser')['scan'], fusion['scan'])
        self.assertEqual(fusion['odom'], 'wheels')
        for node in NODES:
            self.assertEqual(value(loaded, f'/{node}/base_frame'), 'base_footprint')

    def test_tetra_takes_the_mounts_from_one_file(self):
        path = os.path.join(self.folder, 'my.yaml')
        with open(path, 'w') as file:
            file.write('scan_image_fusion: {laser: {from_tf: false, x: 0.77}}')
        loaded = load('tetra_ds3.launch', config=path)
        self.assertEqual(value(loaded, '/scan_image_fusion/laser/x'), 0.77)
        self.assertEqual(value(loaded, '/scan_image_fusion/publish_mounts'), True)
        shipped = load('tetra_ds3.launch')
        for sensor in ('laser', 'camera'):
            self.assertEqual(value(shipped, f'/scan_image_fusion/{sensor}/from_tf'), False)

    def test_tetra_without_some_drivers(self):
        for arguments, without in (({'start_laser': 'false'}, 'laser'),
                                   ({'start_camera': 'false'}, 'camera'),
                                   ({'use_camera': 'false'}, 'camera')):
            with self.subTest(**arguments):
                names = {node.name for node in load('tetra_ds3.launch', **arguments).nodes}
                self.assertEqual({'laser', 'camera'} - names, {without})

    def test_record(self):
        def words(**arguments):
            loaded = load('record.launch', folder='/my bags', name='office', **arguments)
            self.expect_programs(loaded)
            return loaded.nodes[0].args

        topics = 'scan odom image_raw/compressed camera_info /tf /tf_static'
        usual = words().split()
        self.assertEqual(usual[-6:], topics.split())
        self.assertIn('--lz4', usual)
        self.assertNotIn('--split', usual)
        self.assertIn("'/my bags/office'", words())
        pieces = words(split='10m', compression='bz2', image_transport='raw')
        for part in ('--split', '--duration 10m', '--repeat-latched', '--bz2', ' image_raw '):
            self.assertIn(part, pieces)
        self.assertNotIn('compressed', pieces)
        self.assertNotIn('--lz4', words(compression='none'))
        self.assertIn('--duration 600 ', words(split='600'))
        blind = words(use_camera='false', scan_topic='front/scan', odom_topic='wheels')
        self.assertEqual(blind.split()[-4:], ['front/scan', 'wheels', '/tf', '/tf_static'])

    def test_drivers_are_asked_for_before_they_are_started(self):
        """Every program of another package that is not required by package.xml."""
        package = xml.etree.ElementTree.parse(os.path.join(PACKAGE, 'package.xml')).getroot()
        # slam.launch calls its own package or nodelet by that argument.
        known = {depend.text for depend in package} | {'scan_image_slam', '$(arg package)'}
        asked = 0
        for path in glob.glob(os.path.join(PACKAGE, 'launch', '*.launch')):
            launch = xml.etree.ElementTree.parse(path).getroot()
            commands = ' '.join(p.get('command', '') for p in launch.iter('param'))
            for node in launch.iter('node'):
                if node.get('pkg') not in known:
                    asked += 1
                    self.assertIn(f"{node.get('pkg')} {node.get('type')} ", commands)
        self.assertGreaterEqual(asked, 2)

    def test_a_missing_driver_is_named_with_what_to_do(self):
        tool = program('require_node.py')
        for words, told in ((['no_such_driver'], ['package no_such_driver is not installed',
                                                  'apt install ros-noetic-no-such-driver']),
                            (['usb_cam', 'other', '--or', 'start_camera:=false'],
                             ['usb_cam', 'no program other', 'start_camera:=false'])):
            result = subprocess.run([tool, *words], stderr=subprocess.PIPE, text=True)
            self.assertEqual(result.returncode, 1)
            for text in told:
                self.assertIn(text, result.stderr)
        self.assertEqual(subprocess.run([tool, 'usb_cam', 'usb_cam_node'],
                                        stdout=subprocess.PIPE).returncode, 0)

    def test_a_missing_driver_ends_the_launch_before_anything_is_started(self):
        stand_ins, os.environ['ROS_PACKAGE_PATH'] = (os.environ['ROS_PACKAGE_PATH'],
                                                     self.installed['ROS_PACKAGE_PATH'])
        try:
            if 'urg_node' in rospkg.RosPack().list():
                self.skipTest('urg_node is installed')
            with self.assertRaisesRegex(roslaunch.RLException, 'urg_node'):
                load('tetra_ds3.launch')
            self.expect_programs(load('tetra_ds3.launch', start_laser='false',
                                      start_camera='false'))
        finally:
            os.environ['ROS_PACKAGE_PATH'] = stand_ins

    def test_an_unknown_configuration_is_an_error(self):
        with self.assertRaises(roslaunch.RLException):
            load('slam.launch', config='no_such')


if __name__ == '__main__':
    rostest.rosrun('scan_image_slam', 'launch_files', LaunchFilesTest)
