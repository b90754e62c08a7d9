#!/usr/bin/env python3
"""A camera that is not as it should be: the node says so, goes on without it, and with it again."""

import numpy
import rospy
import rostest
from camera_support import CameraTest
from diagnostic_msgs.msg import DiagnosticArray
from live_support import (HEIGHT, WIDTH, Recorder, make_camera_info, make_image, make_odometry,
                          room_scan, wait_for)


class CameraFaultsTest(CameraTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.diagnostics = Recorder('/diagnostics', DiagnosticArray)
        cls.pixels = numpy.full((HEIGHT, WIDTH), 60, numpy.uint8)
        cls.pixels[:, 200:] = 180

    def drive(self, info=None, image=None, image_delay=0.0):
        """One scan with an image; gives its model. Fails if the laser's part is not as ever."""
        type(self).time += 0.1
        t = self.time
        if info is not None:
            info.header.stamp = rospy.Time.from_sec(t)
            self.info.publish(info)
        image = make_image(t - image_delay, self.pixels if image is None else image)
        self.image.publish(image)
        for offset in (-0.05, 0.0, 0.05):
            self.odom.publish(make_odometry(t + offset))
        self.scan.publish(room_scan(t))
        model = self.models.at(t)
        self.assertEqual(sum(1 for r in model.ranges if r < 30), 360)
        return model

    def drive_until(self, has_image, **kwargs):
        """Drives until images are fused, or until they are not any more."""
        wait_for(lambda: self.drive(**kwargs).has_image == has_image,
                 'models with images' if has_image else 'models without images')

    def expect_fault(self, *words, **kwargs):
        heard = len(self.console.messages)
        self.drive_until(True, info=make_camera_info(0))
        # One model is without an image, too, if the image comes to the node after its scan.
        wait_for(lambda: not self.drive(**kwargs).has_image and
                 self.console.found(*words, after=heard), ' '.join(words))
        self.drive_until(True, info=make_camera_info(0))

    # The names put the tests into order: at first nothing has said how the camera sees.
    def test_0_without_camera_info(self):
        wait_for(lambda: not self.drive().has_image, 'a model')
        self.console.said('waiting for topic /camera_info', 'no message has come')
        self.assertFalse(any(m.has_image for m in self.models.messages))
        self.drive_until(True, info=make_camera_info(0))

    def test_zero_k(self):
        self.expect_fault('/camera_info', 'K', 'going on without the camera',
                          info=make_camera_info(0, focal=0.0))

    def test_wrong_size(self):
        self.expect_fault('/image_raw', '320 x 240', '640 x 480',
                          info=make_camera_info(0, width=640, height=480))

    def test_image_of_another_size(self):
        self.expect_fault('/image_raw', '160 x 120', '320 x 240',
                          image=numpy.ascontiguousarray(self.pixels[::2, ::2]))

    def test_unknown_distortion(self):
        info = make_camera_info(0)
        info.distortion_model = 'fish_bowl'
        self.expect_fault('/camera_info', 'fish_bowl', info=info)

    def test_unknown_frame(self):
        self.expect_fault('camera transform', 'cam_link', 'TF holds base_link, camera, laser',
                          info=make_camera_info(0, frame='cam_link'))

    def test_clock_of_another_time(self):
        self.drive_until(True, info=make_camera_info(0))
        heard = len(self.console.messages)

        def told():
            self.drive(image_delay=3.0)
            return any('clock of /image_raw' in m.msg and '3 s older' in m.msg
                       for m in self.console.messages[heard:])
        wait_for(told, 'the clock to be told')
        self.assertFalse(self.drive(image_delay=3.0).has_image)

        def mended():
            self.drive()
            return any('clock of /image_raw: all right now' in m.msg
                       for m in self.console.messages[heard:])
        wait_for(mended, 'the clock to be right')
        self.drive_until(True)

    def test_faults_are_in_diagnostics(self):
        self.drive_until(True, info=make_camera_info(0))
        self.drive_until(False, info=make_camera_info(0, focal=0.0))

        def told(message):
            status = message.status[0]
            return (status.name == 'scan_image_fusion: inputs' and status.level >= 1 and
                    '/camera_info' in status.message)
        self.diagnostics.find(told, 'the fault')
        self.drive_until(True, info=make_camera_info(0))


if __name__ == '__main__':
    rostest.rosrun('scan_image_slam', 'camera_faults', CameraFaultsTest)
