#!/usr/bin/env python3
"""The node bounded_icp alone: hand-made models and odometry in, matches out."""

import math
import signal
import subprocess
import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from live_support import (START, Console, Recorder, make_model, make_odometry, program, publisher,
                          static_transforms, transform, wait_for, wait_subscribed)
from nav_msgs.msg import Odometry
from pose_support import angle_difference, compose
from scan_image_slam.msg import IcpModel, ScanMatch
from std_msgs.msg import String
from visualization_msgs.msg import MarkerArray

PERIOD = 0.025  # [s]
STEP = (0.012, 0.0, 0.004)  # driven between two scans [m, m, rad]
ODOM_FROM_ROOM = (7.0, -3.0, 0.8)  # the encoders begin elsewhere
ENCODER_SCALE = 1.04  # they tell distances too long


class BoundedIcpNodeTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('bounded_icp_node_test')
        cls.model = publisher('icp_model', IcpModel)
        cls.odom = publisher('odom', Odometry)
        cls.command = publisher('syscommand', String)
        cls.console = Console()
        cls.diagnostics = Recorder('/diagnostics', DiagnosticArray)
        cls.matches = Recorder('scan_match', ScanMatch).wait_connected()
        wait_subscribed(cls.model, cls.odom, cls.command)
        cls.time = START
        cls.pose = (0.0, 0.0, 0.0)  # of the base in the room
        cls.odometry = ODOM_FROM_ROOM

    def match(self, step=STEP, encoders=True):
        """Drives a step, scans, and gives the match."""
        cls = type(self)
        cls.time += PERIOD
        cls.pose = compose(cls.pose, step)
        cls.odometry = compose(cls.odometry, (ENCODER_SCALE * step[0], step[1], step[2]))
        if encoders:
            self.odom.publish(make_odometry(self.time, *self.odometry))
        self.model.publish(make_model(self.time, self.pose))
        return self.matches.at(self.time)

    def expect_pose(self, match, expected):
        """Of the base since the first scan of the chain: reference_pose, then motion."""
        reference, motion = match.reference_pose, match.motion
        x, y, yaw = compose((reference.x, reference.y, reference.theta),
                            (motion.x, motion.y, motion.theta))
        self.assertAlmostEqual(x, expected[0], delta=0.005)
        self.assertAlmostEqual(y, expected[1], delta=0.005)
        self.assertAlmostEqual(angle_difference(yaw, expected[2]), 0, delta=math.radians(0.1))

    def start_over(self):
        heard = len(self.console.messages)
        self.command.publish('reset')
        self.console.said('reset by command', after=heard)
        type(self).pose = (0.0, 0.0, 0.0)
        return self.match((0.0, 0.0, 0.0))

    def test_the_motion_is_that_of_the_robot_although_the_encoders_are_wrong(self):
        first = self.start_over()
        self.assertEqual(first.status, ScanMatch.STATUS_FIRST)
        self.assertEqual(first.start_stamp, first.header.stamp)
        for _ in range(100):  # 1.2 m: the encoders alone would be wrong by 48 mm
            match = self.match()
            self.assertEqual(match.status, ScanMatch.STATUS_MATCHED)
            self.assertEqual(match.mode, ScanMatch.MODE_NO_CAMERA)
            self.assertEqual(match.start_stamp, first.header.stamp)
            self.assertLessEqual(match.reference_stamp, match.header.stamp)
            self.assertLess(math.hypot(match.motion.x, match.motion.y), 0.5 + 2 * STEP[0])
        self.expect_pose(match, self.pose)
        self.assertEqual(match.header.frame_id, 'base_link')
        self.assertTrue(match.has_odometry)
        self.assertAlmostEqual(match.odom_pose.x, self.odometry[0], 6)
        self.assertAlmostEqual(match.odom_pose.y, self.odometry[1], 6)
        self.assertLessEqual(abs(match.deviation_distance), match.window_distance)
        self.assertLessEqual(abs(match.deviation_angle), match.window_angle)
        self.assertGreater(match.candidates, 0)
        self.assertEqual(match.points, 360)
        self.assertGreater(match.matched, 0.9 * match.points)
        for i in range(3):
            self.assertGreater(match.covariance[4 * i], 0.0)

    def test_it_goes_on_without_encoders_and_says_so(self):
        self.start_over()
        for _ in range(20):
            self.match()
        for _ in range(40):
            match = self.match(encoders=False)
        self.assertEqual(match.mode, ScanMatch.MODE_LASER_ONLY)
        self.assertFalse(match.has_odometry)
        self.expect_pose(match, self.pose)
        for _ in range(5):
            match = self.match()
        self.assertEqual(match.mode, ScanMatch.MODE_NO_CAMERA)
        self.assertTrue(match.has_odometry)
        self.expect_pose(match, self.pose)

    def test_the_command_reset_begins_a_new_chain(self):
        before = self.match()
        first = self.start_over()
        self.assertGreater(first.start_stamp, before.start_stamp)
        self.expect_pose(self.match(), STEP)
        heard = len(self.matches.messages)
        self.command.publish('clear')  # a word for another node
        for _ in range(5):
            self.assertEqual(self.match().start_stamp, first.start_stamp)
        self.assertEqual(len(self.matches.messages), heard + 5)

    def test_encoders_of_another_of_the_bases_frames(self):
        """Turning on the spot, base_footprint, 0.2 m ahead of the base, goes round it."""
        odom = publisher('other/odom', Odometry)
        model = publisher('other/icp_model', IcpModel)
        node = subprocess.Popen([program('bounded_icp'), '__name:=other_icp', 'odom:=other/odom',
                                 'icp_model:=other/icp_model', 'scan_match:=other/scan_match'])
        try:
            matches = Recorder('other/scan_match', ScanMatch).wait_connected()
            wait_subscribed(odom, model)
            static = static_transforms(transform('base_link', 'base_footprint', x=0.2))
            time = [START]

            def turn(child, frame):
                time[0] += PERIOD
                yaw = 0.02 * (time[0] - START) / PERIOD
                message = make_odometry(time[0], *compose((0.0, 0.0, yaw), (0.2, 0.0, 0.0)))
                message.child_frame_id, message.header.frame_id = child, frame
                odom.publish(message)
                model.publish(make_model(time[0], (0.0, 0.0, yaw)))
                rospy.sleep(PERIOD)
                return matches.messages and matches.messages[-1].has_odometry
            wait_for(lambda: turn('base_footprint', 'wheels'), 'encoders to be used')
            for _ in range(20):
                turn('base_footprint', 'wheels')
            pose = matches.at(time[0]).odom_pose
            self.assertAlmostEqual(math.hypot(pose.x, pose.y), 0.0, places=6)
            self.console.said('frame of /other/odom: it is wheels', 'odom_frame is odom',
                              node='/other_icp')
            turn('wheel_centre', 'odom')
            self.console.said('frame of /other/odom: all right now', node='/other_icp')
            wait_for(lambda: (turn('wheel_centre', 'odom'), self.console.found(
                'no transform base_link -> wheel_centre', 'taken for those of base_link',
                node='/other_icp'))[1], 'the missing transform to be told')
            # Where the base moves there is no place on it.
            wait_for(lambda: (turn('odom', 'odom'), self.console.found(
                'base of /other/odom: no transform base_link -> odom', node='/other_icp'))[1],
                     'a frame that is not on the base to be told')
            static.unregister()
        finally:
            node.send_signal(signal.SIGINT)
            self.assertEqual(node.wait(30), 0)

    def test_unusable_models_are_refused_with_the_reason(self):
        start = self.start_over().start_stamp
        repeated = make_model(self.time, self.pose)
        uneven = make_model(self.time + PERIOD)
        uneven.points_x = uneven.points_x[1:]
        unstamped = make_model(0.0)
        for model, reason in ((repeated, 'not later'), (uneven, 'differ in length'),
                              (unstamped, 'stamp is zero')):
            with self.subTest(reason):
                heard = len(self.matches.messages)
                self.model.publish(model)
                self.assertEqual(self.match().start_stamp, start)
                self.assertEqual(len(self.matches.messages), heard + 1, 'a match too many')
                self.expect_told(reason)

    def expect_told(self, reason):
        """The console tells one reason in five seconds; /diagnostics counts all, and warns."""
        self.diagnostics.find(lambda m: any(reason in value.key for status in m.status
                                            for value in status.values), reason)
        self.diagnostics.find(lambda m: any('was not used' in status.message and status.level > 0
                                            for status in m.status), 'a warning')

    def test_a_laser_that_sees_nothing_is_told_if_it_lasts(self):
        self.start_over()
        for _ in range(5):
            self.match()
        heard = len(self.console.messages)

        def blind():
            type(self).time += PERIOD
            self.odom.publish(make_odometry(self.time, *self.odometry))
            model = make_model(self.time)
            model.ranges = [math.inf] * len(model.ranges)
            model.points_x = model.points_y = [math.nan] * len(model.ranges)
            self.model.publish(model)
            self.assertEqual(self.matches.at(self.time).status, ScanMatch.STATUS_TOO_FEW_POINTS)
        for _ in range(20):  # half a second
            blind()
        self.match((0.0, 0.0, 0.0))
        for _ in range(60):
            blind()
        self.console.said('matching: too few points', 'covered', after=heard)
        self.match((0.0, 0.0, 0.0))
        self.console.said('matching: all right now', after=heard)
        said = [m.msg for m in self.console.messages[heard:]]
        self.assertEqual(sum('all right now' in text for text in said), 1, said)

    def test_the_window_is_drawn_on_demand(self):
        windows = Recorder('search_window', MarkerArray).wait_connected()
        match = self.match()
        markers = windows.find(lambda m: m.markers[0].header.stamp >= match.header.stamp or
                               self.match() is None, 'a window').markers
        self.assertEqual(markers[0].ns, 'window_x10')
        middle = markers[0].points[len(markers[0].points) // 2]
        self.assertGreater(middle.x, 0.0)
        self.assertEqual(middle.y, 0.0)


if __name__ == '__main__':
    rostest.rosrun('scan_image_slam', 'bounded_icp_node', BoundedIcpNodeTest)
