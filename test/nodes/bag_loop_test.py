#!/usr/bin/env python3
"""A bag that is played again and again: time goes back, and each time everything starts over."""

import math
import os
import tempfile
import unittest

import numpy
import rospy
import rostest
from geometry_msgs.msg import PoseWithCovarianceStamped
from live_support import Console, Player, Recorder, read_tum, simulate, wait_for
from nav_msgs.msg import OccupancyGrid, Path
from tf2_msgs.msg import TFMessage

READERS = (('/scan_image_fusion', '/scan'), ('/scan_image_fusion', '/odom'),
           ('/scan_image_fusion', '/tf_static'), ('/bounded_icp', '/odom'))
DURATION = 5.0  # of the bag [s]


def passes_of(poses):
    """Splits messages where their stamps go back."""
    stamps = [m.header.stamp.to_sec() for m in poses]
    cuts = [i for i in range(1, len(poses)) if stamps[i] < stamps[i - 1]]
    return [poses[a:b] for a, b in zip([0] + cuts, cuts + [len(poses)])]


class BagLoopTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('bag_loop_test')
        cls.folder = tempfile.TemporaryDirectory()
        cls.bag = simulate(cls.folder.name, 'loop', '--world', 'laboratory', '--path', 'fast',
                           '--duration', str(DURATION), '--no-images')

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_each_pass_is_like_the_first(self):
        console = Console()
        poses = Recorder('pose', PoseWithCovarianceStamped).wait_connected()
        maps = Recorder('map', OccupancyGrid).wait_connected()
        paths = Recorder('trajectory', Path).wait_connected()
        transforms = Recorder('/tf', TFMessage, key=lambda m: m.transforms[0])
        player = Player(self.bag, READERS, '--loop')
        try:
            wait_for(lambda: len(passes_of(poses.messages)) >= 4, 'the fourth pass')
        finally:
            player.stop()
        first, second, third = passes_of(poses.messages)[:3]
        scans = sorted(read_tum(os.path.join(self.folder.name, 'loop.gt.tum')))
        for one in (second, third):
            # Hardly anything is lost where the bag begins again.
            self.assertLess((one[0].header.stamp.to_nsec() - scans[0]) / 1e9, 0.5)
            self.assertLess((scans[-1] - one[-1].header.stamp.to_nsec()) / 1e9, 0.2)
            self.assertGreater(len(one), 0.9 * len(scans))
            # Everything started over: the poses are again those of the first pass.
            known = {m.header.stamp: m.pose.pose.position for m in first}
            differences = [math.hypot(m.pose.pose.position.x - known[m.header.stamp].x,
                                      m.pose.pose.position.y - known[m.header.stamp].y)
                           for m in one if m.header.stamp in known]
            self.assertGreater(len(differences), 0.8 * len(scans))
            self.assertLess(max(differences), 0.03)
        console.said('time went back', node='/scan_image_fusion', count=2)
        console.said('time went back', node='/bounded_icp', count=2)
        # The map was emptied: the same area is known after each pass.
        known = [numpy.count_nonzero(numpy.array(m.data, numpy.int8) >= 0) for m in maps.messages]
        self.assertLess(max(known), 1.1 * max(known[:len(known) // 3]))  # those of the first pass
        lengths = [len(m.poses) for m in paths.messages]
        self.assertTrue(any(b < a for a, b in zip(lengths, lengths[1:])), 'the path starts anew')
        stamps = [t.header.stamp.to_sec() for t in transforms.messages
                  if t.child_frame_id == 'odom']
        self.assertGreaterEqual(sum(b < a - 1.0 for a, b in zip(stamps, stamps[1:])), 2,
                                'map -> odom goes back with the time')


if __name__ == '__main__':
    rostest.rosrun('scan_image_slam', 'bag_loop', BagLoopTest)
