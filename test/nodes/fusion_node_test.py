#!/usr/bin/env python3
"""The node scan_image_fusion alone: hand-made scans, odometry and images in, models out."""

import math

import numpy
import rospy
import rostest
from camera_support import CameraTest
from live_support import (FOCAL, HEIGHT, WALLS, WIDTH, Recorder, make_camera_info, make_image,
                          make_odometry, make_scan, optical_transform, publisher, room_scan,
                          transform, wait_subscribed)
from scan_image_slam.msg import ScanMatch, VerticalEdge
from sensor_msgs.msg import Image
from visualization_msgs.msg import MarkerArray

LASER = (0.2, 0.1, math.radians(30))  # on the base: x, y, heading


class FusionNodeTest(CameraTest):
    MOUNTS = (transform('base_link', 'laser', LASER[0], LASER[1], 0.3, LASER[2]),
              transform('base_link', 'straight_laser', 0, 0, 0.3),
              optical_transform('base_link', 'camera', 0, 0, 0.5))

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        # The transforms come on a way of their own.
        cls.fuse_until_there()

    @classmethod
    def fuse_until_there(cls):
        for _ in range(600):
            cls.time += 0.025
            cls.scan.publish(room_scan(cls.time))
            rospy.sleep(0.1)
            if cls.models.messages:
                return
        raise AssertionError('no model came')

    def next_time(self, step=1.0):
        type(self).time += step
        return self.time

    def fuse(self, scan):
        """Publishes encoders that stand around the scan, then the scan; gives its model."""
        t = scan.header.stamp.to_sec()
        for offset in (-0.05, 0.0, 0.05):
            self.odom.publish(make_odometry(t + offset))
        self.scan.publish(scan)
        return self.models.at(t)

    def test_points_are_the_ranges_seen_from_the_base(self):
        ranges = [1.0, 2.0, 3.0, 4.0]
        bearings = [-0.5, 0.0, 0.5, 1.0]
        model = self.fuse(make_scan(self.next_time(), ranges, -0.5, 0.5))
        self.assertEqual(model.header.frame_id, 'base_link')
        numpy.testing.assert_allclose(model.bearings, bearings, atol=1e-6)
        numpy.testing.assert_allclose(model.ranges, ranges)
        numpy.testing.assert_allclose([model.laser_x, model.laser_y, model.laser_yaw], LASER,
                                      atol=1e-6)
        self.assertFalse(model.upside_down)
        self.assertFalse(model.has_image)
        for r, b, x, y in zip(ranges, bearings, model.points_x, model.points_y):
            self.assertAlmostEqual(x, LASER[0] + r * math.cos(b + LASER[2]), 5)
            self.assertAlmostEqual(y, LASER[1] + r * math.sin(b + LASER[2]), 5)

    def test_ranges_are_coded_by_rep_117(self):
        ranges = [2.0, math.nan, math.inf, -math.inf, 0.0, 0.001, -1.0, 31.0]
        model = self.fuse(make_scan(self.next_time(), ranges, -0.5, 0.1))
        numpy.testing.assert_array_equal(
            model.ranges, [2.0, math.nan, math.inf, math.nan, math.nan, math.nan, math.nan,
                           math.inf])
        self.assertEqual([math.isfinite(x) for x in model.points_x], [True] + [False] * 7)

    def test_beams_are_corrected_for_the_motion_during_the_sweep(self):
        speed, increment, beams = 0.8, 0.01, 11  # 0.1 s from the first to the last beam
        t = self.next_time()
        scan = make_scan(t, [2.0] * beams, 0.0, 1e-9, 'straight_laser')
        scan.time_increment = increment
        for i in range(-2, 6):
            self.odom.publish(make_odometry(t + 0.05 * i, x=speed * 0.05 * i))
        self.scan.publish(scan)
        model = self.models.at(t)
        self.assertAlmostEqual(model.sweep_velocity_x, speed, 4)
        for i in range(beams):
            self.assertAlmostEqual(model.time_offsets[i], i * increment, 6)
            self.assertAlmostEqual(model.points_x[i], 2.0 + speed * i * increment, 4)

    def test_an_edge_lies_where_the_camera_sees_it_on_the_wall(self):
        column = 200
        pixels = numpy.full((HEIGHT, WIDTH), 60, numpy.uint8)
        pixels[:, column:] = 180
        pictures = Recorder('fusion/image', Image).wait_connected()
        markers = Recorder('fusion/edges', MarkerArray).wait_connected()
        t = self.next_time()
        self.info.publish(make_camera_info(t))
        model = self.fuse_with_image(t, pixels)
        # Between the pixels 199 and 200; in ROS the middle of pixel (0, 0) is at 0.
        bearing = math.atan2(WIDTH / 2 - (column - 0.5), FOCAL)
        strong = [e for e in model.edges if e.weight > 0.5]
        self.assertEqual(len(strong), 1)
        edge = strong[0]
        self.assertEqual(edge.sign, VerticalEdge.DARK_TO_LIGHT)
        self.assertAlmostEqual(edge.bearing, bearing, delta=0.25 / FOCAL)
        self.assertAlmostEqual(edge.range, WALLS[1] / math.cos(bearing), delta=0.01)
        beam = max(range(len(model.ranges)), key=lambda i: model.edge_weights[i])
        self.assertAlmostEqual(model.bearings[beam], bearing, delta=1.01 * math.pi / 360)
        self.assertEqual(model.edge_signs[beam], 1)
        self.assertEqual(pictures.find(lambda m: True).encoding, 'bgr8')
        points = markers.find(lambda m: m.markers[0].points).markers[0].points
        self.assertAlmostEqual(points[0].x, WALLS[1], delta=0.02)
        self.assertFalse(self.fuse(room_scan(self.next_time(0.025), frame='straight_laser'))
                         .has_image, 'an image is used once')

    def test_the_picture_shows_what_became_of_the_edges(self):
        pixels = numpy.full((HEIGHT, WIDTH), 60, numpy.uint8)
        pixels[:, 200:] = 180
        matches = publisher('scan_match', ScanMatch)
        pictures = Recorder('fusion/image', Image).wait_connected()
        self.info.publish(make_camera_info(self.next_time()))
        # While a picture is wanted, and not longer, the matching is listened to.
        self.fuse_with_image(self.next_time(), pixels)
        wait_subscribed(matches)

        def has_red(picture):
            colours = numpy.frombuffer(picture.data, numpy.uint8).reshape(-1, 3).astype(int)
            return bool(((colours[:, 2] > 250) & (colours[:, :2].max(axis=1) < 5)).sum() > 50)
        model = self.fuse_with_image(self.next_time(0.1), pixels)
        match = ScanMatch()
        match.header.stamp = match.start_stamp = match.reference_stamp = model.header.stamp
        match.edge_uses = bytes([ScanMatch.EDGE_REFUSED] * len(model.edges))
        match.edge_residuals = [0.0] * len(model.edges)
        self.assertFalse(any(has_red(picture) for picture in pictures.messages))
        matches.publish(match)
        pictures.find(has_red, 'refused edges')
        matches.publish(ScanMatch())
        self.console.said('/scan_match', 'was not used', 'stamp is zero')

    def fuse_with_image(self, t, pixels):
        """The first model that an image was fused into: topics go different ways."""
        for _ in range(100):
            self.image.publish(make_image(t, pixels))
            model = self.fuse(room_scan(t, frame='straight_laser'))
            if model.has_image:
                return model
            t = self.next_time(0.1)
            self.info.publish(make_camera_info(t))
        self.fail('no image was fused')

    def test_a_laser_of_an_unknown_frame_is_named(self):
        self.scan.publish(room_scan(self.next_time(), frame='lazer'))
        self.console.said('laser transform', 'base_link', 'lazer', 'did you mean laser')
        model = self.fuse(room_scan(self.next_time()))
        self.assertAlmostEqual(model.laser_x, LASER[0], 6)


if __name__ == '__main__':
    rostest.rosrun('scan_image_slam', 'fusion_node', FusionNodeTest)
