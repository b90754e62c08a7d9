#!/usr/bin/env python3
"""One coloured scene in every encoding that cameras use: the edges are the same."""

import math

import cv2
import numpy
import rospy
import rostest
from camera_support import CameraTest
from live_support import (FOCAL, HEIGHT, WIDTH, Recorder, make_camera_info, make_image,
                          make_odometry, publisher, room_scan, wait_for, wait_subscribed)
from scan_image_slam.msg import IcpModel
from sensor_msgs.msg import CompressedImage

# Stripes from left to right: first column and colour (blue, green, red). Their columns are even, as
# the cells of a mosaic are.
STRIPES = ((0, (40, 50, 30)), (80, (120, 160, 200)), (140, (60, 40, 90)), (230, (190, 180, 140)))
SIGNS = (1, -1, 1)


def scene():
    bgr = numpy.zeros((HEIGHT, WIDTH, 3), numpy.uint8)
    for column, colour in STRIPES:
        bgr[:, column:] = colour
    return bgr


def mosaic(bgr, pattern):
    """What a sensor behind colour filters sees; `pattern` names its first four pixels by rows."""
    grey = numpy.empty(bgr.shape[:2], numpy.uint8)
    for i, letter in enumerate(pattern):
        channel = 'bgr'.index(letter)
        grey[i // 2::2, i % 2::2] = bgr[i // 2::2, i % 2::2, channel]
    return grey


def yuv422(bgr, first):
    """Bytes U Y V Y (`first` = 'u') or Y U Y V ('y') for each two pixels."""
    yuv = cv2.cvtColor(bgr, cv2.COLOR_BGR2YUV)
    packed = numpy.empty(bgr.shape[:2] + (2,), numpy.uint8)
    luma, chroma = (1, 0) if first == 'u' else (0, 1)
    packed[:, :, luma] = yuv[:, :, 0]
    packed[:, 0::2, chroma] = yuv[:, 0::2, 1]
    packed[:, 1::2, chroma] = yuv[:, 0::2, 2]
    return packed


class ImageEncodingsTest(CameraTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.compressed_image = publisher('image_raw/compressed', CompressedImage)
        cls.compressed_models = Recorder('compressed/icp_model', IcpModel).wait_connected()
        wait_subscribed(cls.compressed_image)
        wait_for(lambda: cls.scan.get_num_connections() == 2, 'both nodes')

    def edges_of(self, image, image_publisher, models):
        """The strong edges of the first model with the image, as (column, sign)."""
        for _ in range(200):
            type(self).time += 0.1
            image.header.stamp = rospy.Time.from_sec(self.time)
            self.info.publish(make_camera_info(self.time))
            image_publisher.publish(image)
            for offset in (-0.05, 0.0, 0.05):
                self.odom.publish(make_odometry(self.time + offset))
            self.scan.publish(room_scan(self.time))
            rospy.sleep(0.05)  # gives the image, which goes another way, time to overtake the next
            for model in reversed(models.messages):
                if model.has_image and model.header.stamp.to_sec() > self.begin:
                    return sorted((WIDTH / 2 - FOCAL * math.tan(e.bearing), e.sign)
                                  for e in model.edges if e.weight > 0.5)
        self.fail(f'no image was fused')

    def expect_edges(self, image, tolerance, image_publisher=None, models=None):
        # Nothing of the image before may be left.
        type(self).time += 1.0
        self.begin = self.time
        edges = self.edges_of(image, image_publisher or self.image, models or self.models)
        self.assertEqual([sign for _, sign in edges], list(SIGNS))
        for (column, _), (begin, _) in zip(edges, STRIPES[1:]):
            self.assertAlmostEqual(column, begin - 0.5, delta=tolerance)

    def test_grey(self):
        grey = cv2.cvtColor(scene(), cv2.COLOR_BGR2GRAY)
        for encoding in ('mono8', '8UC1'):
            with self.subTest(encoding):
                self.expect_edges(make_image(0, grey, encoding), 0.25)
        for encoding in ('mono16', '16UC1'):
            with self.subTest(encoding):
                self.expect_edges(make_image(0, grey.astype(numpy.uint16) * 256, encoding), 0.25)

    def test_colour(self):
        bgr = scene()
        opaque = numpy.full(bgr.shape[:2] + (1,), 255, numpy.uint8)
        rgb = numpy.ascontiguousarray(bgr[:, :, ::-1])
        pictures = {'bgr8': bgr, 'rgb8': rgb, 'bgra8': numpy.concatenate((bgr, opaque), axis=2),
                    'rgba8': numpy.concatenate((rgb, opaque), axis=2)}
        for encoding, pixels in pictures.items():
            with self.subTest(encoding):
                self.expect_edges(make_image(0, pixels, encoding), 0.25)

    def test_mosaics(self):
        for pattern in ('rggb', 'bggr', 'gbrg', 'grbg'):
            with self.subTest(pattern):
                image = make_image(0, mosaic(scene(), pattern), f'bayer_{pattern}8')
                self.expect_edges(image, 0.5)
            with self.subTest(pattern + ' labelled as mono8'):
                self.expect_edges(make_image(0, mosaic(scene(), pattern), 'mono8'), 0.75)

    def test_yuv422(self):
        self.expect_edges(make_image(0, yuv422(scene(), 'u'), 'yuv422'), 0.25)

    def test_compressed(self):
        for ending, image_format in (('.png', 'bgr8; png compressed bgr8'),
                                     ('.jpg', 'bgr8; jpeg compressed bgr8')):
            with self.subTest(image_format):
                message = CompressedImage()
                message.header.frame_id = 'camera'
                message.format = image_format
                message.data = cv2.imencode(ending, scene())[1].tobytes()
                self.expect_edges(message, 0.25, self.compressed_image, self.compressed_models)

    def test_what_can_not_be_read_is_named(self):
        grey = cv2.cvtColor(scene(), cv2.COLOR_BGR2GRAY)
        self.info.publish(make_camera_info(self.time))
        unknown = make_image(self.time, grey, 'grey9')
        self.image.publish(unknown)
        self.console.said('image_raw', "encoding 'grey9'")
        short = CompressedImage(format='jpeg', data=b'\xff\xd8\xff')
        short.header.stamp = rospy.Time.from_sec(self.time)
        self.compressed_image.publish(short)
        self.console.said('image_raw/compressed', "format 'jpeg'", 'no JPEG or PNG')


if __name__ == '__main__':
    rostest.rosrun('scan_image_slam', 'image_encodings', ImageEncodingsTest)
