#!/usr/bin/env python3
"""The simulated robot: what its drivers publish and how often; it goes where it is told."""

import math
import unittest

import numpy
import rospy
import rostest
from geometry_msgs.msg import PoseStamped, Twist
from live_support import Recorder, publisher, wait_for, wait_subscribed
from nav_msgs.msg import Odometry
from pose_support import angle_difference, yaw_of
from sensor_msgs.msg import CameraInfo, Image, LaserScan
from tf2_msgs.msg import TFMessage


def stamps(recorder):
    return numpy.array([m.header.stamp.to_sec() for m in recorder.messages])


class RobotSimulatorTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('robot_simulator_test')
        cls.command = publisher('cmd_vel', Twist)
        cls.scans = Recorder('scan', LaserScan)
        cls.odometry = Recorder('odom', Odometry)
        cls.infos = Recorder('camera_info', CameraInfo)
        cls.images = Recorder('image_raw', Image)
        cls.truths = Recorder('ground_truth', PoseStamped)
        cls.transforms = Recorder('/tf', TFMessage, key=lambda m: m.transforms[0])
        cls.static = Recorder('/tf_static', TFMessage)
        wait_subscribed(cls.command)
        for recorder in (cls.scans, cls.odometry, cls.infos, cls.images, cls.truths):
            recorder.wait_connected().find(lambda m: True)

    def expect_rate(self, recorder, rate, count=60):
        """By stamps, whatever the machine has time for; queues may drop messages."""
        wait_for(lambda: len(recorder.messages) >= count, 'messages on ' + recorder.topic)
        steps = numpy.diff(stamps(recorder))
        self.assertTrue(numpy.all(steps > 0), 'stamps advance')
        self.assertAlmostEqual(float(numpy.median(steps)) * rate, 1.0, delta=0.02)
        self.assertAlmostEqual(float(numpy.min(steps)) * rate, 1.0, delta=0.25)

    def test_rates(self):
        self.expect_rate(self.scans, 40.0)
        self.expect_rate(self.truths, 40.0)
        self.expect_rate(self.odometry, 30.0)
        self.expect_rate(self.images, 30.0, 30)

    def test_the_laser_is_an_utm_30lx_ew(self):
        scan = self.scans.messages[0]
        self.assertEqual(scan.header.frame_id, 'laser')
        self.assertEqual(len(scan.ranges), 1081)
        self.assertAlmostEqual(scan.angle_min, math.radians(-135), 5)
        self.assertAlmostEqual(scan.angle_increment, math.radians(0.25), 7)
        self.assertAlmostEqual(scan.time_increment, 0.025 / 1440, 9)
        self.assertAlmostEqual(scan.scan_time, 0.025, 6)
        self.assertEqual((scan.range_min, scan.range_max), (numpy.float32(0.1), 30.0))
        hits = [r for r in scan.ranges if scan.range_min <= r <= scan.range_max]
        self.assertGreater(len(hits), 800)
        self.assertLess(max(hits), math.hypot(11.4, 10) + 0.2, 'the laboratory is not larger')

    def test_image_and_camera_info_belong_together(self):
        # Connections begin one after the other: what came by the first has no partner yet.
        def info_of(image):
            return next((m for m in self.infos.messages if m.header.stamp == image.header.stamp),
                        None)
        image = self.images.find(info_of)
        info = info_of(image)
        self.assertEqual((image.width, image.height, image.encoding), (640, 480, 'bgr8'))
        self.assertEqual(image.header.frame_id, 'camera_optical_frame')
        self.assertEqual(len(image.data), 640 * 480 * 3)
        pixels = numpy.frombuffer(image.data, numpy.uint8)
        self.assertGreater(pixels.std(), 10, 'the picture shows something')
        self.assertEqual((info.width, info.height), (640, 480))
        self.assertGreater(info.K[0], 0)
        self.assertEqual(info.header.frame_id, image.header.frame_id)

    def test_the_sensors_are_in_tf(self):
        message = self.static.find(lambda m: True)
        self.assertEqual({(t.header.frame_id, t.child_frame_id) for t in message.transforms},
                         {('base_link', 'laser'), ('base_link', 'camera_optical_frame')})

    def test_the_truth_is_on_its_own_topic_only(self):
        topics = {topic for topic, nodes in rospy.get_master().getSystemState()[2][0]
                  if '/robot_simulator' in nodes and not topic.startswith('/image_raw/')}
        self.assertEqual(topics, {'/scan', '/odom', '/image_raw', '/camera_info', '/tf',
                                  '/tf_static', '/ground_truth', '/simulation_finished',
                                  '/rosout'})
        self.assertEqual({(t.header.frame_id, t.child_frame_id)
                          for t in self.transforms.messages}, {('odom', 'base_link')})
        # The robot starts at (3.4, 2.2) of the laboratory, which its encoders can't know.
        self.assertAlmostEqual(self.truths.messages[0].pose.position.x, 3.4, delta=1e-3)
        self.assertAlmostEqual(self.odometry.messages[0].pose.pose.position.x, 0, delta=0.01)

    def drive(self, speed, turn_rate, done, what):
        """Tells a velocity again and again, as teleoperation does, until the truth is as wanted."""
        twist = Twist()
        twist.linear.x, twist.angular.z = speed, turn_rate

        def is_done():
            self.command.publish(twist)
            return done(self.truths.messages[-1].pose)
        wait_for(is_done, what)

    def speed(self):
        """Of the truth, over the last scans [m/s]."""
        first, last = self.truths.messages[-5], self.truths.messages[-1]
        way = math.hypot(last.pose.position.x - first.pose.position.x,
                         last.pose.position.y - first.pose.position.y)
        return way / (last.header.stamp - first.header.stamp).to_sec()

    def test_it_is_driven_by_cmd_vel(self):
        start = self.truths.messages[-1].pose
        odom_start = self.odometry.messages[-1].pose.pose
        self.drive(0.4, 0.0, lambda p: p.position.x > start.position.x + 0.5, 'half a metre')
        self.assertAlmostEqual(self.truths.messages[-1].pose.position.y, start.position.y,
                               delta=0.05)
        # The encoders saw it, roughly.
        way = self.odometry.messages[-1].pose.pose.position.x - odom_start.position.x
        self.assertGreater(way, 0.4)
        # A robot that is told nothing any more stops.
        wait_for(lambda: self.speed() < 0.005, 'a standing robot')
        heading = yaw_of(self.truths.messages[-1].pose.orientation)
        self.drive(0.0, 0.13,
                   lambda p: angle_difference(yaw_of(p.orientation), heading) > 0.2, 'a turn left')
        self.drive(0.0, -0.13,
                   lambda p: angle_difference(yaw_of(p.orientation), heading) < -0.1,
                   'a turn right')
        twists = [m.twist.twist.angular.z for m in self.odometry.messages]
        self.assertGreater(max(twists), 0.05)
        self.assertLess(min(twists), -0.05)


if __name__ == '__main__':
    rostest.rosrun('scan_image_slam', 'robot_simulator', RobotSimulatorTest)
