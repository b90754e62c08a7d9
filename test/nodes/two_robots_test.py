#!/usr/bin/env python3
"""Two robots at one master, each in its namespace: they have nothing in common, unless one is given
the map of the other."""

import math
import os
import shutil
import unittest

import numpy
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped
from live_support import Console, Recorder, wait_for
from nav_msgs.srv import GetMap
from pose_support import angle_difference, compared, compose, inverse
from scan_image_slam.srv import StateFile
from tf2_msgs.msg import TFMessage

ROBOTS = ('/robot_1', '/robot_2')
FOR_ALL = {'/tf', '/tf_static', '/diagnostics', '/rosout'}
LENGTH, WIDTH = 11.4, 10.0  # of the laboratory, from the origin of its world [m]


def known(robot):
    """{(x, y)} of the cells of its map of which something is known [cells]."""
    grid = robot.get_map().map
    data = numpy.array(grid.data, numpy.int8).reshape(grid.info.height, grid.info.width)
    x, y = (round(v / grid.info.resolution)
            for v in (grid.info.origin.position.x, grid.info.origin.position.y))
    return {(column + x, row + y) for row, column in numpy.argwhere(data >= 0)}


def transforms_of(topic):
    def edges(message):
        return {(t.header.frame_id, t.child_frame_id) for t in message.transforms}
    return Recorder(topic, TFMessage, key=edges)


class Robot:
    def __init__(self, space):
        self.space = space
        self.folder = rospy.get_param(space + '/mapper/map_folder')
        self.truths = Recorder(space + '/ground_truth', PoseStamped)
        self.poses = Recorder(space + '/pose', PoseWithCovarianceStamped)
        self.get_map = rospy.ServiceProxy(space + '/dynamic_map', GetMap)

    def compared(self):
        return compared(self.truths.messages, self.poses.messages)

    def way(self):
        points = numpy.array([truth[:2] for truth, _ in self.compared()]).reshape(-1, 2)
        return float(numpy.sum(numpy.hypot(*numpy.diff(points, axis=0).T)))

    def map_from_world(self):
        """As the first pose tells."""
        truth, pose = self.compared()[0]
        return compose(pose, inverse(truth))


class TwoRobotsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('two_robots_test')
        cls.console = Console()
        cls.diagnostics = Recorder('/diagnostics', DiagnosticArray)
        cls.transforms = [transforms_of('/tf'), transforms_of('/tf_static')]
        cls.robots = [Robot(space) for space in ROBOTS]
        for robot in cls.robots:
            wait_for(lambda robot=robot: robot.way() > 3.0, robot.space + ' to have driven')

    @classmethod
    def tearDownClass(cls):
        for robot in cls.robots:
            shutil.rmtree(robot.folder, ignore_errors=True)

    def expect_followed(self, compared, map_from_world):
        self.assertTrue(compared)
        for truth, pose in compared:
            x, y, yaw = compose(map_from_world, truth)
            self.assertLess(math.hypot(pose[0] - x, pose[1] - y), 0.1)
            self.assertLess(abs(angle_difference(pose[2], yaw)), math.radians(2.0))

    def expect_laboratory(self, robot, map_from_world):
        """Nothing is drawn outside of its four walls, and much of each of them."""
        grid = robot.get_map().map
        self.assertEqual(grid.header.frame_id, robot.space[1:] + '/map')
        data = numpy.array(grid.data, numpy.int8).reshape(grid.info.height, grid.info.width)
        row, column = numpy.nonzero(data > 65)
        x, y, _ = compose(inverse(map_from_world), (
            grid.info.origin.position.x + (column + 0.5) * grid.info.resolution,
            grid.info.origin.position.y + (row + 0.5) * grid.info.resolution, 0.0))
        inside = numpy.array([x, LENGTH - x, y, WIDTH - y])  # distance from each wall [m]
        self.assertGreater(inside.min(), -0.15)
        for wall in inside:
            self.assertGreater(numpy.count_nonzero(wall < 0.15), 20)

    def test_each_maps_its_own_world(self):
        for robot in self.robots:
            with self.subTest(robot.space):
                self.assertEqual({m.header.frame_id for m in robot.poses.messages},
                                 {robot.space[1:] + '/map'})
                map_from_world = robot.map_from_world()
                self.expect_followed(robot.compared(), map_from_world)
                self.expect_laboratory(robot, map_from_world)
        one, other = (robot.map_from_world() for robot in self.robots)
        self.assertGreater(abs(angle_difference(one[2], other[2])), 1.0, 'maps can be told apart')

    def test_one_tree_for_each_robot(self):
        expected = set()
        for space in ROBOTS:
            prefix = space[1:] + '/'
            expected |= {(prefix + parent, prefix + child) for parent, child in
                         (('map', 'odom'), ('odom', 'base_link'), ('base_link', 'laser'),
                          ('base_link', 'camera_optical_frame'))}

        def told():
            return set().union(*(e for recorder in self.transforms for e in recorder.messages))
        wait_for(lambda: expected <= told(), lambda: f'the transforms; there are {told()}')
        self.assertEqual(told(), expected)

    def test_nothing_is_shared_by_mistake(self):
        for kind, entries in zip(('publishes', 'subscribes', 'serves'),
                                 rospy.get_master().getSystemState()[2]):
            for name, nodes in entries:
                for node in nodes:
                    space = node[:len(ROBOTS[0])]
                    if space in ROBOTS and name not in FOR_ALL:
                        self.assertTrue(name.startswith(space + '/'), f'{node} {kind} {name}')
        for name in rospy.get_param_names():
            self.assertFalse(name.split('/')[1] in ('scan_image_fusion', 'bounded_icp', 'mapper',
                                                    'robot_simulator'), name)

    def test_diagnostics_tell_whose_they_are(self):
        def named():
            return {status.name for message in self.diagnostics.messages
                    for status in message.status}
        expected = {f'{space[1:]}/{node}: inputs' for space in ROBOTS
                    for node in ('scan_image_fusion', 'bounded_icp', 'mapper')}
        wait_for(lambda: expected <= named(), lambda: f'the diagnostics; there are {named()}')

    def test_the_map_of_one_is_gone_on_with_by_the_other(self):
        giver, taker = self.robots
        map_from_world = giver.map_from_world()
        before = known(giver)
        saved = rospy.ServiceProxy(giver.space + '/save_state', StateFile)('shared.state')
        self.assertTrue(saved.success, saved.message)
        self.assertEqual(os.path.dirname(saved.path), giver.folder)
        loaded = rospy.ServiceProxy(taker.space + '/load_state', StateFile)(saved.path)
        self.assertTrue(loaded.success, loaded.message)
        found, = self.console.said('was found in the loaded map', node=taker.space + '/mapper')

        def later():
            """Poses that are told in the new map: of scans since then."""
            return [m for m in taker.poses.messages if m.header.stamp > found.header.stamp]
        wait_for(lambda: len(later()) > 80, 'poses in the other map')
        self.expect_followed(compared(taker.truths.messages, later()), map_from_world)
        self.expect_laboratory(taker, map_from_world)
        self.assertLess(len(before - known(taker)), 0.01 * len(before))
        save = rospy.ServiceProxy(taker.space + '/save_state', StateFile)
        wait_for(lambda: os.path.getsize(save('grown.state').path) > os.path.getsize(saved.path),
                 'the map to grow')
        # The giver knows nothing of it.
        self.expect_followed(giver.compared(), map_from_world)
        self.expect_laboratory(giver, map_from_world)


if __name__ == '__main__':
    rostest.rosrun('scan_image_slam', 'two_robots', TwoRobotsTest)
