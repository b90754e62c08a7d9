#!/usr/bin/env python3
"""Bags whose time does not run evenly: a pause, a leap of the clock, transforms that come late."""

import os
import tempfile
import time
import unittest

import rosbag
import rospy
import rostest
from geometry_msgs.msg import PoseWithCovarianceStamped
from live_support import Player, Recorder, read_tum, simulate, wait_for
from pose_support import off_by, pose_of
from std_srvs.srv import SetBool

READERS = (('/scan_image_fusion', '/scan'), ('/scan_image_fusion', '/tf'),
           ('/scan_image_fusion', '/tf_static'), ('/bounded_icp', '/tf'))
DURATION = 9.0  # of the bag [s]


class BagTimesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('bag_times_test')
        cls.folder = tempfile.TemporaryDirectory()
        cls.bag = simulate(cls.folder.name, 'drive', '--world', 'laboratory', '--path', 'fast',
                           '--duration', str(DURATION), '--no-images')
        cls.truth = read_tum(cls.bag[:-4] + '.gt.tum')
        cls.scans = sorted(cls.truth)
        cls.poses = Recorder('pose', PoseWithCovarianceStamped).wait_connected()

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def rewrite(self, name, change):
        """The bag with each message as `change`(topic, seconds since the first) will have it: its
        time of arrival, or None to leave it out."""
        path = os.path.join(self.folder.name, name + '.bag')
        with rosbag.Bag(self.bag) as source, rosbag.Bag(path, 'w') as target:
            begin = rospy.Time(source.get_start_time())
            for topic, message, stamp in source.read_messages():
                seconds = change(topic, (stamp - begin).to_sec())
                if seconds is not None:
                    target.write(topic, message, begin + rospy.Duration(seconds))
        return path

    def play(self, bag, *options, meanwhile=None):
        """Gives the poses, {stamp: pose}."""
        before = len(self.poses.messages)
        player = Player(bag, self.readers(bag), *options)
        if meanwhile:
            meanwhile()
        player.wait()

        def ended():
            new = self.poses.messages[before:]
            return new and new[-1].header.stamp.to_nsec() == self.scans[-1]
        wait_for(ended, 'the last pose')
        return {m.header.stamp.to_nsec(): pose_of(m.pose.pose)
                for m in self.poses.messages[before:]}

    @staticmethod
    def readers(bag):
        with rosbag.Bag(bag) as opened:
            topics = opened.get_type_and_topic_info().topics
        return [(node, topic) for node, topic in READERS if topic in topics]

    def expect_every_scan(self, poses, played):
        first = self.scans.index(min(poses))
        self.assertLess(first, 40, 'poses begin within the first second')
        missing = [s for s in played if s >= self.scans[first] and s not in poses]
        self.assertEqual(missing, [])

    def expect_true(self, poses, within):
        first = min(poses)
        for stamp, pose in poses.items():
            error = off_by((self.truth[first], poses[first]), (self.truth[stamp], pose))
            self.assertLess(error, within, f'{(stamp - first) / 1e9:.3f} s after the first')

    def test_pause(self):
        pause = rospy.ServiceProxy('/player/pause_playback', SetBool)
        half = self.scans[len(self.scans) // 2]
        heard = len(self.poses.messages)

        def pause_halfway():
            wait_for(lambda: any(m.header.stamp.to_nsec() >= half
                                 for m in self.poses.messages[heard:]), 'the middle of the bag')
            pause(True)
            time.sleep(3.0)  # longer than any patience of the nodes
            pause(False)
        poses = self.play(self.bag, meanwhile=pause_halfway)
        self.expect_every_scan(poses, self.scans)
        self.expect_true(poses, 0.03)

    def test_clock_leaps_ahead(self):
        def cut(topic, seconds):
            return None if 4.0 <= seconds < 6.0 and topic != '/tf_static' else seconds
        poses = self.play(self.rewrite('leap', cut), '--skip-empty=0.5')
        begin = self.scans[0]
        self.expect_every_scan(poses, [s for s in self.scans if not 3.9e9 <= s - begin < 6.1e9])
        self.assertFalse([s for s in poses if 4.1e9 < s - begin < 5.9e9])
        # Across the gap there are the encoders, and then the match in a wider window.
        self.expect_true(poses, 0.05)

    def test_late_transforms_instead_of_odometry(self):
        def delay(topic, seconds):
            if topic == '/odom':
                return None
            return seconds + 0.1 if topic == '/tf' else seconds
        poses = self.play(self.rewrite('late', delay))
        self.expect_every_scan(poses, self.scans)
        self.expect_true(poses, 0.03)


if __name__ == '__main__':
    rostest.rosrun('scan_image_slam', 'bag_times', BagTimesTest)
