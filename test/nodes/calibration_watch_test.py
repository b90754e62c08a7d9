#!/usr/bin/env python3
"""A camera that does not fit the laser: the fusion node notices it while the robot drives."""

import math
import re

import numpy
import rostest
from camera_support import CameraTest
from diagnostic_msgs.msg import DiagnosticArray
from dynamic_reconfigure.client import Client
from live_support import (FOCAL, HEIGHT, START, WIDTH, Recorder, cast, make_camera_info, make_image,
                          make_odometry, make_scan, optical_transform, transform, wait_for)

PERIOD = 0.1  # of the scans [s]
LEAD = 0.03  # of an image before its scan [s]
# Dark panels around the robot, before the bright walls of the room.
PANELS = [(-1.7, 0.11), (-1.1, 0.08), (-0.6, 0.13), (0.1, 0.09), (0.5, 0.1), (1.0, 0.07),
          (1.6, 0.12)]  # direction and half of the width [rad]
DISTANCE = 1.5  # [m]
PROBLEM = 'camera calibration'
OFFSET = 'camera time offset by edges on objects [ms]'


def on_panel(heading):
    return numpy.any([numpy.abs(heading - middle) < half for middle, half in PANELS], axis=0)


def yaw_at(seconds):
    """The robot turns to and fro."""
    return math.sin(0.7 * (seconds - START))


def scan_at(seconds):
    increment = 0.004
    bearings = -2.0 + increment * numpy.arange(1001)
    heading = yaw_at(seconds) + bearings
    ranges = numpy.where(on_panel(heading), DISTANCE, cast(0.0, 0.0, heading))
    return make_scan(seconds, ranges, -2.0, increment)


def picture_at(seconds):
    rays = 8  # to a column
    column = (numpy.arange(WIDTH * rays) + 0.5) / rays - 0.5
    heading = yaw_at(seconds) - numpy.arctan((column - WIDTH / 2) / FOCAL)
    row = numpy.where(on_panel(heading), 60.0, 180.0).reshape(WIDTH, rays).mean(axis=1)
    return numpy.tile(row.astype(numpy.uint8), (HEIGHT, 1))


class CalibrationWatchTest(CameraTest):
    MOUNTS = (transform('base_link', 'laser', 0, 0, 0.3),
              optical_transform('base_link', 'camera', 0, 0, 0.3))

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.diagnostics = Recorder('/diagnostics', DiagnosticArray)

    def drive(self, seconds, late=0.0, focal=FOCAL):
        """Images are taken `late` seconds after what their stamps say."""
        for _ in range(round(seconds / PERIOD)):
            type(self).time += PERIOD
            t = self.time
            self.info.publish(make_camera_info(t, focal=focal))
            self.image.publish(make_image(t - LEAD, picture_at(t - LEAD + late)))
            for k in range(5):
                stamp = t + PERIOD * k / 5
                self.odom.publish(make_odometry(stamp, yaw=yaw_at(stamp)))
            self.scan.publish(scan_at(t))
            self.models.at(t)

    def now_told(self):
        """What the diagnostics say from now on."""
        begin = len(self.diagnostics.messages)

        def newest():
            found = [m.status[0] for m in self.diagnostics.messages[begin:]
                     if m.status[0].name.startswith('scan_image_fusion')]
            return found[-1] if len(found) > 1 else None
        status = wait_for(newest, 'diagnostics of the fusion')
        return status, {value.key: value.value for value in status.values}

    def assert_nothing_is_known(self):
        status, values = self.now_told()
        self.assertEqual(values[OFFSET], 'not known')
        self.assertNotIn(PROBLEM, status.message)
        self.assertFalse([m for m in self.console.messages if PROBLEM + ': all right' in m.msg])

    # The names put the tests into order: each drives on from the one before.
    def test_0_a_camera_that_fits(self):
        self.assertEqual(self.now_told()[1][OFFSET], 'not known')
        self.drive(40.0)
        self.assertTrue(any(m.has_image for m in self.models.messages))
        status, values = self.now_told()
        self.assertLessEqual(abs(float(values[OFFSET])), 2.0)
        self.assertLess(abs(float(values['camera yaw by edges on objects [deg]'])), 0.1)
        self.assertNotIn(PROBLEM, status.message)

    def test_1_images_that_are_taken_late(self):
        self.drive(60.0, late=0.05)
        status, values = self.now_told()
        self.assertLessEqual(abs(float(values[OFFSET]) - 50.0), 3.0)
        self.assertRegex(status.message, PROBLEM + '.*took its pictures (4[7-9]|5[0-3]) ms later')
        self.assertIsNone(re.search('looked .* deg', status.message))
        self.assertGreaterEqual(status.level, 1)
        self.console.said(PROBLEM, 'ms later', 'calibrate_camera_laser')

    def test_2_other_parameters_leave_it_as_it_is(self):
        Client('scan_image_fusion', timeout=60).update_configuration({'odom_max_wait': 0.02})
        status, values = self.now_told()
        self.assertLessEqual(abs(float(values[OFFSET]) - 50.0), 3.0)
        self.assertIn(PROBLEM, status.message)

    def test_3_another_calibration_is_looked_at_anew(self):
        self.drive(1.0, late=0.05, focal=FOCAL + 0.5)
        self.assert_nothing_is_known()

    def test_4_another_time_offset_too(self):
        self.drive(30.0, late=0.05)
        self.assertIn(PROBLEM, self.now_told()[0].message)
        Client('scan_image_fusion', timeout=60).update_configuration({'camera_time_offset': 0.001})
        self.drive(1.0, late=0.05)
        self.assert_nothing_is_known()

    def test_5_a_camera_that_is_away_may_come_back_elsewhere(self):
        self.drive(30.0, late=0.05)
        self.assertIn(PROBLEM, self.now_told()[0].message)
        for step in range(25):
            stamp = self.time + 1.0 + step
            self.scan.publish(scan_at(stamp))
            self.models.at(stamp)
        self.assert_nothing_is_known()


if __name__ == '__main__':
    rostest.rosrun('scan_image_slam', 'calibration_watch', CalibrationWatchTest)
