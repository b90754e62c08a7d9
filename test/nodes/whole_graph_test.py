#!/usr/bin/env python3
"""A simulated drive played to the three nodes, and the same bag through slam_offline.

With the parameter ~manager, the nodes are nodelets of that manager."""

import json
import math
import os
import tempfile
import unittest

import numpy
import rosbag
import rospy
import rostest
from geometry_msgs.msg import PoseWithCovarianceStamped
from live_support import Player, Recorder, program, read_tum, run, simulate, wait_for
from nav_msgs.msg import OccupancyGrid, Path
from pose_support import angle_difference, yaw_of
from rosgraph_msgs.msg import Clock
from scan_image_slam.msg import ScanMatch
from tf2_msgs.msg import TFMessage

START_UP = 1.0  # poses may be missing so long, while topics connect [s]
READERS = (('/scan_image_fusion', '/scan'), ('/scan_image_fusion', '/odom'),
           ('/scan_image_fusion', '/camera_info'), ('/scan_image_fusion', '/image_raw/compressed'),
           ('/scan_image_fusion', '/tf_static'), ('/bounded_icp', '/odom'))


class WholeGraphTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('whole_graph_test')
        cls.folder = tempfile.TemporaryDirectory()
        cls.bag = simulate(cls.folder.name, 'drive', '--world', 'laboratory', '--path', 'fast',
                           '--duration', '12')
        cls.offline = os.path.join(cls.folder.name, 'offline')
        run(program('slam_offline'), '--bag', cls.bag, '--out', cls.offline,
            '--set', 'scan_image_fusion/odom_max_wait=0.1')  # as live
        with rosbag.Bag(cls.bag) as bag:
            cls.scans = [message.header.stamp.to_nsec()
                         for _, message, _ in bag.read_messages('/scan')]
        cls.play()

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    @classmethod
    def play(cls):
        cls.poses = Recorder('pose', PoseWithCovarianceStamped).wait_connected()
        cls.matches = Recorder('scan_match', ScanMatch).wait_connected()
        cls.map = Recorder('map', OccupancyGrid).wait_connected()
        cls.path = Recorder('trajectory', Path).wait_connected()
        cls.clock = Recorder('/clock', Clock, key=lambda m: m.clock.to_sec())
        cls.corrections = []  # (clock, stamp) at the arrival of map -> odom [s]
        subscriber = rospy.Subscriber('/tf', TFMessage, cls.on_transforms, queue_size=1000)
        manager = rospy.get_param('~manager', None)
        Player(cls.bag, [(manager or node, topic) for node, topic in READERS]).wait()
        wait_for(lambda: cls.poses.messages and
                 cls.poses.messages[-1].header.stamp.to_nsec() == cls.scans[-1], 'the last pose')
        subscriber.unregister()

    @classmethod
    def on_transforms(cls, message):
        for transform in message.transforms:
            if (transform.header.frame_id, transform.child_frame_id) == ('map', 'odom'):
                now = rospy.get_time()
                cls.corrections.append((now, transform.header.stamp.to_sec()))

    def test_every_pose_is_that_of_slam_offline(self):
        offline = read_tum(os.path.join(self.offline, 'online.tum'))
        self.assertEqual(sorted(offline), self.scans)
        live = {m.header.stamp.to_nsec(): m.pose.pose for m in self.poses.messages}
        worst_way = worst_angle = 0.0
        for stamp in self.scans:
            if stamp not in live:
                self.assertLess(stamp - self.scans[0], START_UP * 1e9, f'no pose at {stamp}')
                continue
            x, y, yaw = offline[stamp]
            pose = live[stamp]
            worst_way = max(worst_way, math.hypot(pose.position.x - x, pose.position.y - y))
            worst_angle = max(worst_angle,
                              abs(angle_difference(yaw_of(pose.orientation), yaw)))
        print(f'largest differences: {1e3 * worst_way:.2f} mm, '
              f'{math.degrees(worst_angle):.4f} deg, {len(self.scans) - len(live)} poses missing')
        self.assertLess(worst_way, 0.005)
        self.assertLess(math.degrees(worst_angle), 0.1)
        self.assertEqual(len(self.poses.messages), len(live), 'one pose for each scan')

    def test_the_poses_are_those_of_the_robot(self):
        truth = read_tum(self.bag[:-4] + '.gt.tum')
        first = self.poses.messages[0]
        last = self.poses.messages[-1]
        moved = [math.hypot(b[0] - a[0], b[1] - a[1]) for a, b in
                 [(truth[first.header.stamp.to_nsec()], truth[last.header.stamp.to_nsec()])]][0]
        self.assertGreater(moved, 2.0, 'the robot drove')
        a, b = first.pose.pose.position, last.pose.pose.position
        self.assertAlmostEqual(math.hypot(b.x - a.x, b.y - a.y), moved, delta=0.03)

    def test_map_to_odom_is_there_from_the_first_second_and_ahead_of_time(self):
        begin = self.scans[0] / 1e9
        self.assertLess(self.corrections[0][1], begin + 1.0)
        stamps = numpy.array([stamp for _, stamp in self.corrections])
        self.assertTrue(numpy.all(numpy.diff(stamps) > 0))
        # Each is stamped later than the newest time that is known where it arrives.
        # (Before the first /clock this test knows none.)
        ahead = numpy.array([stamp - clock for clock, stamp in self.corrections if clock > 0.0])
        self.assertGreater(float(numpy.median(ahead)), 0.0)
        self.assertLess(float(numpy.max(ahead)), 0.2)
        # Every scan after that finds transforms around it.
        self.assertGreaterEqual(stamps[-1], self.scans[-1] / 1e9)

    def test_the_mode_is_full_in_both(self):
        late = [m for m in self.matches.messages
                if m.header.stamp.to_nsec() > self.scans[0] + START_UP * 1e9]
        self.assertEqual({m.mode for m in late}, {ScanMatch.MODE_FULL})
        with open(os.path.join(self.offline, 'report.json')) as file:
            modes = json.load(file)['modes']
        self.assertGreater(modes['full_s'], 11.0)
        self.assertAlmostEqual(sum(modes.values()), (self.scans[-1] - self.scans[0]) / 1e9, 3)

    def test_map_and_path_grow(self):
        grid = wait_for(lambda: self.map.messages, 'a map')[-1]
        data = numpy.array(grid.data, numpy.int8)
        cell = grid.info.resolution ** 2
        self.assertGreater(numpy.count_nonzero((data >= 0) & (data < 25)) * cell, 50.0,
                           'at least half of the laboratory is free [m^2]')
        self.assertGreater(numpy.count_nonzero(data > 65), 300)
        self.assertGreater(len(self.path.messages[-1].poses), 40)


if __name__ == '__main__':
    rostest.rosrun('scan_image_slam', 'whole_graph', WholeGraphTest)
