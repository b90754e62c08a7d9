#!/usr/bin/env python3
"""Bad scans in the middle of a drive: the nodes say why and go on, and good scans still match."""

import math
import os
import re
import struct
import unittest

import numpy
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseWithCovarianceStamped
from live_support import (Console, Recorder, cast, make_odometry, make_scan, process_of,
                          publisher, room_scan, static_transforms, transform, wait_for,
                          wait_subscribed)
from nav_msgs.msg import Odometry
from pose_support import angle_difference, compose, yaw_of
from scan_image_slam.msg import ScanMatch
from sensor_msgs.msg import LaserScan

PERIOD = 0.025  # [s]
STEP = (0.01, 0.0, 0.004)  # driven between two scans [m, m, rad]


class ForgedScan(LaserScan):
    """Claims to have as many ranges as the format can tell: 16 GiB of them."""

    def serialize(self, buff):
        super().serialize(buff)
        ranges = 4 * len(self.ranges)  # [byte]; behind them comes the number of intensities
        buff.seek(-(ranges + 8), os.SEEK_END)
        buff.write(struct.pack('<I', 0xffffffff))
        buff.seek(0, os.SEEK_END)


def peak_memory(process):
    """Of a process [byte]."""
    with open(f'/proc/{process}/status') as status:
        return 1024 * int(re.search(r'VmHWM:\s*(\d+) kB', status.read())[1])


class BadScansTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('bad_scans_test')
        cls.static = static_transforms(
            transform('base_link', 'laser', 0, 0, 0.3),
            transform('base_link', 'hanging_laser', 0.1, -0.05, 0.4, roll=math.pi),
            transform('base_link', 'turned_laser', -0.1, 0.2, 0.4, yaw=2.0),
            transform('base_link', 'hanging_turned_laser', 0.1, 0.2, 0.4, yaw=-2.5, roll=math.pi),
            transform('base_link', 'tilted_laser', 0.1, 0.0, 0.4, roll=0.5))
        cls.scan = publisher('scan', LaserScan)
        cls.odom = publisher('odom', Odometry)
        cls.diagnostics = Recorder('/diagnostics', DiagnosticArray)
        cls.console = Console().wait_connected()
        cls.matches = Recorder('scan_match', ScanMatch).wait_connected()
        cls.poses = Recorder('pose', PoseWithCovarianceStamped).wait_connected()
        wait_for(lambda: cls.odom.get_num_connections() == 2, 'both readers of odom')
        wait_subscribed(cls.scan)
        cls.time = rospy.get_time()
        cls.pose = (0.0, 0.0, 0.0)
        wait_for(cls.is_seen, 'the transform of the laser')

    @classmethod
    def is_seen(cls):
        """Stands and scans until the first match."""
        cls.time += PERIOD
        cls.odom.publish(make_odometry(cls.time))
        cls.scan.publish(room_scan(cls.time))
        rospy.sleep(0.1)
        return cls.matches.messages

    def advance(self):
        cls = type(self)
        cls.time += PERIOD
        cls.pose = compose(cls.pose, STEP)
        self.odom.publish(make_odometry(self.time, *self.pose))

    def drive(self, count, scan_at=room_scan):
        for _ in range(count):
            self.advance()
            self.scan.publish(scan_at(self.time, self.pose))
            match = self.matches.at(self.time)
        return match

    def expect_good(self, match):
        """The match is one, and the pose is where the robot is in the room: the map's origin."""
        self.assertEqual(match.status, ScanMatch.STATUS_MATCHED)
        self.assertEqual(match.mode, ScanMatch.MODE_NO_CAMERA)
        pose = self.poses.at(match.header.stamp.to_sec()).pose.pose
        self.assertAlmostEqual(pose.position.x, self.pose[0], delta=0.01)
        self.assertAlmostEqual(pose.position.y, self.pose[1], delta=0.01)
        self.assertAlmostEqual(angle_difference(yaw_of(pose.orientation), self.pose[2]), 0,
                               delta=math.radians(0.2))

    def expect_told(self, *words):
        """The console tells one reason in five seconds; /diagnostics counts all."""
        def told(message):
            return any(all(w in value.key for w in words)
                       for status in message.status for value in status.values)
        self.diagnostics.find(told, f'{words}')

    def refuse(self, scan_at, *words):
        """Publishes a scan of which there must be no match, between good ones."""
        self.expect_good(self.drive(3))
        before = len(self.matches.messages)
        self.scan.publish(scan_at(self.time + PERIOD / 2))
        self.expect_good(self.drive(3))
        self.assertEqual(len(self.matches.messages), before + 3)
        self.expect_told('/scan', *words)

    def test_a_good_drive(self):
        self.expect_good(self.drive(40))

    def test_scans_that_see_nothing(self):
        for value in (math.nan, math.inf, -math.inf, 0.0, 0.001, -1.0, 1e9):
            with self.subTest(value):
                self.expect_good(self.drive(3))
                blind = self.drive(3, lambda t, pose, v=value: make_scan(t, [v] * 360))
                self.assertEqual(blind.status, ScanMatch.STATUS_TOO_FEW_POINTS)
                self.assertEqual(blind.mode, ScanMatch.MODE_COASTING)
                self.expect_good(self.drive(3))

    def test_scans_with_some_bad_beams(self):
        bad = [math.nan, math.inf, 0.0, 0.001, -1.0]

        def mixed(t, pose):
            scan = room_scan(t, pose)
            scan.ranges = [bad[i % 5] if i % 4 == 0 else r for i, r in enumerate(scan.ranges)]
            return scan
        match = self.drive(10, mixed)
        self.assertEqual(match.points, 270)
        self.expect_good(match)

    def test_another_number_of_beams(self):
        self.expect_good(self.drive(5, lambda t, pose: room_scan(t, pose, beams=36)))
        self.expect_good(self.drive(5, lambda t, pose: room_scan(t, pose, beams=1440)))
        self.expect_good(self.drive(5))

    def test_a_clockwise_scan(self):
        def clockwise(t, pose):
            increment = -2 * math.pi / 360
            bearings = math.pi + increment * numpy.arange(360)
            return make_scan(t, cast(pose[0], pose[1], pose[2] + bearings), math.pi, increment)
        self.expect_good(self.drive(10, clockwise))

    def test_lasers_that_hang_or_are_turned(self):
        for frame, mount, hangs in (('hanging_laser', (0.1, -0.05, 0.0), True),
                                    ('turned_laser', (-0.1, 0.2, 2.0), False),
                                    ('hanging_turned_laser', (0.1, 0.2, -2.5), True)):
            def scan_at(t, pose, frame=frame, mount=mount, hangs=hangs):
                x, y, yaw = compose(pose, mount)
                bearings = -math.pi + 2 * math.pi / 360 * numpy.arange(360)
                return make_scan(t, cast(x, y, yaw + (-bearings if hangs else bearings)),
                                 frame=frame)
            with self.subTest(frame):
                self.expect_good(self.drive(10, scan_at))

    def test_a_tilted_laser_is_refused(self):
        for _ in range(2):  # not only once
            self.refuse(lambda t: room_scan(t, frame='tilted_laser'), 'tilted by')

    def test_a_scan_without_frame_is_not_used(self):
        self.expect_good(self.drive(3))
        before = len(self.matches.messages)
        self.scan.publish(room_scan(self.time + PERIOD / 2, frame=''))
        self.expect_good(self.drive(3))
        self.assertEqual(len(self.matches.messages), before + 3)

    def test_an_empty_scan(self):
        self.refuse(lambda t: make_scan(t, []), 'no beams')

    def test_a_geometry_that_can_not_be(self):
        for increment, reason in ((0.0, 'angle_increment is zero'), (math.nan, 'not finite'),
                                  (0.1, 'more than a turn')):
            self.refuse(lambda t, i=increment: make_scan(t, [2.0] * 360, increment=i), reason)

    def test_stamps_that_do_not_advance(self):
        self.refuse(lambda t: room_scan(t - PERIOD / 2, self.pose), 'not later')  # repeats
        self.refuse(lambda t: room_scan(t - 5.0, self.pose), 'not later')
        self.refuse(lambda t: room_scan(0.0, self.pose), 'stamp is zero')

    def test_a_scan_from_the_future_is_left_out(self):
        poses = len(self.poses.messages)
        self.refuse(lambda t: room_scan(t + 30.0, self.pose), 'leaps ahead')
        self.assertEqual(len(self.poses.messages), poses + 6)

    def test_a_scan_that_claims_to_be_longer_than_it_is(self):
        self.expect_good(self.drive(3))
        before = len(self.matches.messages)
        scan = room_scan(self.time + PERIOD / 2, self.pose)
        forged = ForgedScan()
        forged.header, forged.ranges = scan.header, scan.ranges
        for _ in range(3):
            self.scan.publish(forged)
        machine = os.sysconf('SC_PHYS_PAGES') * os.sysconf('SC_PAGE_SIZE')
        node = '/scan_image_fusion'
        self.console.said('Exception thrown when deserializing', node=node, count=3)
        self.assertLess(peak_memory(process_of(node)), max(machine / 4, 2 ** 31) + 2 ** 29)
        self.expect_good(self.drive(3))
        self.assertEqual(len(self.matches.messages), before + 3)

    def test_time_that_goes_back_for_good(self):
        """More and more stale scans mean that a clock was set: the matching starts over, and
        the mapper goes on from where the encoders are."""
        self.expect_good(self.drive(3))
        cls = type(self)
        cls.time -= 100.0
        cls.pose = (0.0, 0.0, 0.0)

        def is_back():
            cls.time += PERIOD
            self.odom.publish(make_odometry(self.time))
            self.scan.publish(room_scan(self.time))
            rospy.sleep(0.02)
            return self.matches.messages[-1].header.stamp.to_sec() < self.time + 1
        wait_for(is_back, 'a match of the new time')
        self.expect_good(self.drive(10))


if __name__ == '__main__':
    rostest.rosrun('scan_image_slam', 'bad_scans', BadScansTest)
