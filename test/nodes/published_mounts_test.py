#!/usr/bin/env python3
"""scan_image_fusion publishes the mounts that its parameters give, under the frames that the
messages of the sensors name."""

import math
import unittest

import numpy
import rospy
import rostest
from live_support import (START, Recorder, make_camera_info, publisher, room_scan, wait_for,
                          wait_subscribed)
from sensor_msgs.msg import CameraInfo, LaserScan
from tf2_msgs.msg import TFMessage


class PublishedMountsTest(unittest.TestCase):
    def test_both_are_published_together(self):
        rospy.init_node('published_mounts_test')
        static = Recorder('/tf_static', TFMessage)
        scan, info = publisher('scan', LaserScan), publisher('camera_info', CameraInfo)
        wait_subscribed(scan, info)
        scan.publish(room_scan(START, frame='/front_laser'))
        info.publish(make_camera_info(START, frame='eye'))

        def together():
            """A late subscriber gets the last message only: it must hold both."""
            found = [{t.child_frame_id: t for t in m.transforms} for m in static.messages]
            return next((t for t in found if set(t) == {'front_laser', 'eye'}), None)

        transforms = wait_for(together, lambda: 'both transforms; there are %s' % static.messages)
        half = math.sqrt(0.5)
        # The camera looks along x: z of its optical frame is x of the base, x is -y, y is -z.
        expected = {'front_laser': ((0.2, -0.1, 0.3), (0, 0, half, half)),
                    'eye': ((0.1, 0, 0.5), (-0.5, 0.5, -0.5, 0.5))}
        for frame, (translation, rotation) in expected.items():
            transform = transforms[frame].transform
            self.assertEqual(transforms[frame].header.frame_id, 'base')
            t, q = transform.translation, transform.rotation
            numpy.testing.assert_allclose((t.x, t.y, t.z), translation, atol=1e-9)
            got = numpy.array((q.x, q.y, q.z, q.w))
            numpy.testing.assert_allclose(got * numpy.sign(got[3]), rotation, atol=1e-9)


if __name__ == '__main__':
    rostest.rosrun('scan_image_slam', 'published_mounts', PublishedMountsTest)
