#!/usr/bin/env python3
"""The node mapper alone: hand-made models and matches in, pose, paths, map, TF and services out."""

import math
import os
import shutil
import time
import unittest

import numpy
import rospy
import rostest
import yaml
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import Pose2D, PoseWithCovarianceStamped
from live_support import (START, WALLS, Console, Recorder, make_model, publisher, stamp_of,
                          wait_for, wait_subscribed, yaw_quaternion)
from map_msgs.msg import OccupancyGridUpdate
from nav_msgs.msg import MapMetaData, OccupancyGrid, Path
from nav_msgs.srv import GetMap
from pose_support import angle_difference, compose, inverse, yaw_of
from scan_image_slam.msg import IcpModel, ScanMatch
from scan_image_slam.srv import SaveMap
from std_msgs.msg import String
from std_srvs.srv import SetBool, Trigger
from tf2_msgs.msg import TFMessage

PERIOD = 0.1  # [s]
STEP = 0.1  # [m]
FREE, OCCUPIED = 25, 65  # the limits of map_saver [%]
VARIANCES = (1e-4, 4e-4, 9e-6)  # forward, left, turn


def make_match(seconds, start, pose, odom):
    """Of the base at `pose` since the stamp `start`; `odom`: what the encoders say, or None."""
    match = ScanMatch()
    match.header.stamp = stamp_of(seconds)
    match.header.frame_id = 'base_link'
    match.start_stamp = match.reference_stamp = stamp_of(start)
    match.motion = Pose2D(*pose)
    for i, variance in enumerate(VARIANCES):
        match.covariance[4 * i] = variance
    match.status = ScanMatch.STATUS_MATCHED
    match.has_odometry = odom is not None
    if odom is not None:
        match.odom_pose = Pose2D(*odom)
    return match


def cells(grid):
    return numpy.array(grid.data, numpy.int8).reshape(grid.info.height, grid.info.width)


def cell_at(grid, x, y):
    """Value at a point of the map [m]; None outside."""
    column = math.floor((x - grid.info.origin.position.x) / grid.info.resolution + 1e-9)
    row = math.floor((y - grid.info.origin.position.y) / grid.info.resolution + 1e-9)
    if not (0 <= column < grid.info.width and 0 <= row < grid.info.height):
        return None
    return grid.data[row * grid.info.width + column]


class MapperNodeTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('mapper_node_test')
        cls.folder = rospy.get_param('mapper/map_folder')
        cls.model = publisher('icp_model', IcpModel)
        cls.match = publisher('scan_match', ScanMatch)
        cls.initial_pose = publisher('initialpose', PoseWithCovarianceStamped)
        cls.console = Console()
        cls.commands = Recorder('syscommand', String).wait_connected()
        cls.diagnostics = Recorder('/diagnostics', DiagnosticArray)
        cls.poses = Recorder('pose', PoseWithCovarianceStamped).wait_connected()
        cls.maps = Recorder('map', OccupancyGrid).wait_connected()
        cls.updates = Recorder('map_updates', OccupancyGridUpdate).wait_connected()
        cls.paths = Recorder('trajectory', Path).wait_connected()
        cls.encoder_paths = Recorder('encoder_trajectory', Path).wait_connected()
        cls.transforms = Recorder('/tf', TFMessage, key=lambda m: m.transforms[0]).wait_connected()
        wait_subscribed(cls.model, cls.match, cls.initial_pose)
        wait_for(lambda: cls.match.get_num_connections() > 0, 'the mapper')
        for name in ('dynamic_map', 'reset', 'pause', 'save_map'):
            rospy.wait_for_service(name, 60)
        cls.get_map = rospy.ServiceProxy('dynamic_map', GetMap)
        cls.reset = rospy.ServiceProxy('reset', Trigger)
        cls.pause = rospy.ServiceProxy('pause', SetBool)
        cls.save_map = rospy.ServiceProxy('save_map', SaveMap)
        cls.time = START

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder, ignore_errors=True)

    def setUp(self):
        """A new chain whose base stands at the origin of the room."""
        self.assertTrue(self.reset().success)
        type(self).time += 10.0
        self.start = self.time
        self.way = 0.0

    def drive(self, count, odom_of=lambda pose: pose):
        """`count` scans along x; gives the last pose of the base since the start."""
        for _ in range(count):
            pose = (self.way, 0.0, 0.0)
            self.model.publish(make_model(self.time, pose, beams=720))
            self.match.publish(make_match(self.time, self.start, pose, odom_of(pose)))
            self.poses.at(self.time)
            type(self).time += PERIOD
            self.way += STEP
        return pose

    def current_map(self, condition, what):
        """The map of the service, once it is as the condition says: models lag behind poses."""
        def get():
            try:
                grid = self.get_map().map
            except rospy.ServiceException:
                return None
            return grid if grid.info.width > 0 and condition(grid) else None
        return wait_for(get, 'a map with ' + what)

    def expect_paused(self, value):
        """What /diagnostics tell from now on."""
        heard = len(self.diagnostics.messages)

        def told():
            return any(status.name == 'mapper: inputs' and pair.key == 'paused'
                       and pair.value == value
                       for message in self.diagnostics.messages[heard:]
                       for status in message.status for pair in status.values)
        wait_for(told, f'"paused: {value}" in the diagnostics')

    def expect_pose(self, message, expected):
        pose = message.pose.pose
        self.assertAlmostEqual(pose.position.x, expected[0], 6)
        self.assertAlmostEqual(pose.position.y, expected[1], 6)
        self.assertAlmostEqual(angle_difference(yaw_of(pose.orientation), expected[2]), 0, 6)

    def test_pose_and_its_covariance_are_in_the_axes_of_the_map(self):
        odom_from_start = (3.0, 2.0, math.pi / 2)
        self.drive(3, lambda pose: compose(odom_from_start, pose))
        message = self.poses.at(self.time - PERIOD)
        self.assertEqual(message.header.frame_id, 'map')
        # The map begins where the encoders begin: 0.2 m ahead is now along y.
        self.expect_pose(message, (3.0, 2.2, math.pi / 2))
        covariance = message.pose.covariance
        self.assertAlmostEqual(covariance[0], VARIANCES[1], 12)
        self.assertAlmostEqual(covariance[7], VARIANCES[0], 12)
        self.assertAlmostEqual(covariance[35], VARIANCES[2], 12)

    def test_map_to_odom_takes_up_the_error_of_the_encoders(self):
        def odom_of(pose):
            return (1.1 * pose[0], 0.02, 0.3 * pose[0])
        last = self.drive(6, odom_of)
        expected = compose(compose((0.0, 0.02, 0.0), last), inverse(odom_of(last)))

        def is_expected(t):
            return (t.header.frame_id == 'map' and t.child_frame_id == 'odom' and
                    abs(t.transform.translation.x - expected[0]) < 1e-6 and
                    abs(t.transform.translation.y - expected[1]) < 1e-6 and
                    abs(yaw_of(t.transform.rotation) - expected[2]) < 1e-6)
        self.transforms.find(is_expected, f'the transform {expected}')

    def feed(self, space, moments):
        """Matches alone, at {seconds: what the encoders say, or None}, all at the same place."""
        match = publisher(space + 'scan_match', ScanMatch)
        poses = Recorder(space + 'pose', PoseWithCovarianceStamped).wait_connected()
        wait_for(lambda: match.get_num_connections() > 0, 'the mapper of ' + space)
        for seconds, odom in moments.items():
            match.publish(make_match(START + seconds, START, (0.0, 0.0, 0.0), odom))
            poses.at(START + seconds)

    def parents(self, child):
        return {t.header.frame_id for t in self.transforms.messages if t.child_frame_id == child}

    def test_without_encoders_the_base_is_in_the_map(self):
        self.feed('without/', {0.0: None, 0.5: None})
        time.sleep(0.3)  # six times the period of the transforms
        self.assertEqual(self.parents('carried'), set())
        self.feed('without/', {1.0: None})
        wait_for(lambda: self.parents('carried') == {'map'}, 'map -> carried')

    def test_late_encoders_leave_the_base_its_one_parent(self):
        self.feed('late/', {0.0: None, 0.5: None, 0.9: (1.0, 0.0, 0.0), 2.5: None})
        self.transforms.find(lambda t: t.child_frame_id == 'late_odom' and
                             abs(t.transform.translation.x + 1.0) < 1e-6, 'map -> late_odom')
        time.sleep(0.3)
        self.assertEqual(self.parents('late_base'), set())

    def test_the_map_shows_the_room(self):
        metadata = Recorder('map_metadata', MapMetaData)
        self.drive(12)
        middle = (WALLS[1] + 0.01, 0.01)
        grid = self.current_map(lambda g: (cell_at(g, *middle) or 0) > 90, 'the wall ahead')
        self.assertEqual(grid.header.frame_id, 'map')
        self.assertAlmostEqual(grid.info.resolution, 0.05)
        for x in numpy.arange(WALLS[0] + 0.1, WALLS[1] - 0.1, 0.2):
            for y in numpy.arange(WALLS[2] + 0.1, WALLS[3] - 0.1, 0.2):
                self.assertLess(cell_at(grid, x, y), FREE, f'({x}, {y}) is free')
                self.assertGreaterEqual(cell_at(grid, x, y), 0, f'({x}, {y}) is known')
        occupied = numpy.argwhere(cells(grid) >= OCCUPIED)
        self.assertGreater(len(occupied), 200)
        for row, column in occupied:
            x = grid.info.origin.position.x + 0.05 * (column + 0.5)
            y = grid.info.origin.position.y + 0.05 * (row + 0.5)
            off = min(abs(x - WALLS[0]), abs(x - WALLS[1]), abs(y - WALLS[2]), abs(y - WALLS[3]))
            self.assertLess(off, 0.051, f'({x}, {y}) is no wall')
        self.assertIn(cell_at(grid, WALLS[1] + 0.3, 0.0), (-1, None))
        published = self.maps.find(lambda m: m.info.width == grid.info.width and
                                   (cell_at(m, *middle) or 0) > 90, 'the same map')
        self.assertEqual(metadata.find(lambda m: m.width == grid.info.width).height,
                         published.info.height)

    def test_updates_are_what_has_changed(self):
        known = len(self.maps.messages)
        self.drive(3)
        whole = wait_for(lambda: self.maps.messages[known:], 'the new map')[0]
        heard = len(self.updates.messages)
        self.drive(10)
        update = wait_for(lambda: self.updates.messages[heard:], 'an update')[-1]
        self.assertEqual(len(update.data), update.width * update.height)
        grid = self.maps.find(lambda m: m.header.stamp == update.header.stamp, 'its map')
        part = cells(grid)[update.y:update.y + update.height, update.x:update.x + update.width]
        numpy.testing.assert_array_equal(
            numpy.array(update.data, numpy.int8).reshape(part.shape), part)
        self.assertEqual(whole.info.resolution, grid.info.resolution)

    def test_the_paths_are_estimate_and_encoders(self):
        heard = len(self.paths.messages), len(self.encoder_paths.messages)
        self.drive(10, lambda pose: (1.5 * pose[0], 0.0, 0.0))

        def whole_path(recorder, since):
            return wait_for(lambda: [m for m in recorder.messages[since:] if len(m.poses) == 10],
                            'the whole path')[-1]

        path = whole_path(self.paths, heard[0])
        encoders = whole_path(self.encoder_paths, heard[1])
        for i in range(10):
            self.assertAlmostEqual(path.poses[i].pose.position.x, STEP * i, 6)
            self.assertAlmostEqual(encoders.poses[i].pose.position.x, 1.5 * STEP * i, 6)

    def test_initialpose_moves_the_robot_in_the_map(self):
        self.drive(2)
        message = PoseWithCovarianceStamped()
        message.header.frame_id = 'map'
        message.pose.pose.position.x = 10.0
        yaw_quaternion(message.pose.pose.orientation, math.pi / 2)
        heard = len(self.console.messages)
        self.initial_pose.publish(message)
        self.console.said('the pose was set', after=heard)
        self.drive(1)  # 0.1 m on
        self.expect_pose(self.poses.at(self.time - PERIOD), (10.0, STEP, math.pi / 2))
        message.header.frame_id = 'odom'
        self.initial_pose.publish(message)
        self.console.said('initialpose', 'odom', 'expected is map', after=heard)
        self.drive(1)
        self.expect_pose(self.poses.at(self.time - PERIOD), (10.0, 2 * STEP, math.pi / 2))

    def test_reset_empties_the_map_and_tells_the_matcher(self):
        self.drive(3)
        self.current_map(lambda g: True, 'anything')
        heard = len(self.commands.messages)
        self.assertTrue(self.reset().success)
        with self.assertRaises(rospy.ServiceException):
            self.get_map()
        self.assertEqual(wait_for(lambda: self.commands.messages[heard:], 'a command')[0].data,
                         'reset')

    def test_pause_leaves_the_map_but_not_the_pose(self):
        self.drive(3)
        before = self.current_map(lambda g: True, 'anything')
        self.expect_paused('no')
        self.assertTrue(self.pause(True).success)
        self.expect_paused('yes')
        self.way = 20.0  # the room would be drawn far away from the first one
        last = self.drive(3)
        self.expect_pose(self.poses.at(self.time - PERIOD), last)
        self.assertEqual(self.get_map().map.info.width, before.info.width)
        self.assertTrue(self.pause(False).success)
        self.expect_paused('no')
        self.drive(2)
        self.current_map(lambda g: g.info.width > before.info.width, 'the room beyond')

    def test_save_map_writes_what_map_server_loads(self):
        self.drive(5)
        grid = self.current_map(lambda g: (cell_at(g, WALLS[1] + 0.01, 0.01) or 0) > 65, 'a wall')
        reply = self.save_map('sub/room')
        self.assertTrue(reply.success, reply.message)
        self.assertTrue(os.path.isabs(reply.path))
        with open(reply.path) as file:
            saved = yaml.safe_load(file)
        self.assertAlmostEqual(saved['resolution'], 0.05)
        with open(os.path.join(os.path.dirname(reply.path), saved['image']), 'rb') as file:
            content = file.read()
        magic, width, height, brightest = content.split(maxsplit=4)[:4]
        width, height = int(width), int(height)
        self.assertEqual((magic, brightest), (b'P5', b'255'))
        pixels = numpy.frombuffer(content[-width * height:], numpy.uint8)
        pixels = pixels.reshape(height, width)[::-1]  # pictures start at the top
        share = (255 - pixels.astype(float)) / 255  # as map_server reads it
        walls = free = 0
        for row in range(height):
            for column in range(width):
                # The middle of the cell, in the map.
                value = cell_at(grid, saved['origin'][0] + 0.05 * (column + 0.5),
                                saved['origin'][1] + 0.05 * (row + 0.5))
                is_wall = value is not None and value >= OCCUPIED
                is_free = value is not None and 0 <= value <= FREE
                self.assertEqual(share[row, column] > saved['occupied_thresh'], is_wall)
                self.assertEqual(share[row, column] < saved['free_thresh'], is_free)
                walls += is_wall
                free += is_free
        self.assertGreater(walls, 200)
        self.assertGreater(free, 10000)

    def test_save_map_writes_nothing_outside_its_folder(self):
        self.drive(2)
        self.current_map(lambda g: True, 'anything')
        outside = os.path.join(os.path.dirname(self.folder), 'mapper_node_test_outside')
        for name in ('../mapper_node_test_outside', outside, ''):
            reply = self.save_map(name)
            self.assertFalse(reply.success)
            self.assertTrue(reply.message)
        self.assertFalse(os.path.exists(outside + '.yaml'))

    def test_save_map_without_a_map_says_so(self):
        reply = self.save_map('nothing')
        self.assertFalse(reply.success)
        self.assertIn('no map yet', reply.message)


if __name__ == '__main__':
    rostest.rosrun('scan_image_slam', 'mapper_node', MapperNodeTest)
