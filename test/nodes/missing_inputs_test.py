#!/usr/bin/env python3
"""What a node lacks at the start it names within five seconds, and again until it is there; and what
is there twice."""

import signal
import subprocess
import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from live_support import (START, Console, Recorder, make_odometry, program, publisher, room_scan,
                          static_transforms, transform, wait_for, wait_subscribed)
from nav_msgs.msg import Odometry
from scan_image_slam.msg import IcpModel
from sensor_msgs.msg import LaserScan
from tf2_msgs.msg import TFMessage


class MissingInputsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('missing_inputs_test')
        cls.console = Console()
        cls.nodes = []

    def start(self, name, *arguments):
        """Starts a node, and gives the moment from which on it was there [s]."""
        self.nodes.append(subprocess.Popen([program(name), *arguments]))
        node = '/' + name
        for argument in arguments:
            if argument.startswith('__name:='):
                node = '/' + argument[len('__name:='):]
        # It is there when it has told the master what it publishes.
        wait_for(lambda: any(node in publishers for _, publishers in
                             rospy.get_master().getSystemState()[2][0]), 'the node ' + node)
        return rospy.get_time()

    def tearDown(self):
        for node in self.nodes:
            node.send_signal(signal.SIGINT)
        for node in self.nodes:
            self.assertEqual(node.wait(30), 0)
        self.nodes.clear()

    def expect_named(self, begin, *words, node):
        first, second = self.console.said(*words, node=node, count=2)[:2]
        self.assertLess(first.header.stamp.to_sec() - begin, 5.0)
        self.assertLess((second.header.stamp - first.header.stamp).to_sec(), 6.0)

    def test_topics(self):
        begin = self.start('scan_image_fusion')
        self.expect_named(begin, 'waiting for topic /scan', 'sensor_msgs/LaserScan', 'nobody',
                          node='/scan_image_fusion')
        self.console.said('waiting for topic /odom', '(optional)', node='/scan_image_fusion')
        self.console.said('waiting for topic /image_raw', '(optional)', node='/scan_image_fusion')
        self.console.said('waiting for topic /camera_info', '(optional)',
                          node='/scan_image_fusion')

    def test_remapped_topics_are_named_as_they_are(self):
        begin = self.start('scan_image_fusion', '__name:=front_fusion', 'scan:=front/scan')
        self.expect_named(begin, 'waiting for topic /front/scan', node='/front_fusion')

    def test_the_topic_of_bounded_icp(self):
        begin = self.start('bounded_icp')
        self.expect_named(begin, 'waiting for topic /icp_model', 'nobody', node='/bounded_icp')

    def test_the_topic_of_mapper(self):
        begin = self.start('mapper')
        self.expect_named(begin, 'waiting for topic /scan_match', 'nobody', node='/mapper')

    def test_two_lasers_on_one_topic(self):
        for name in ('right', 'wrong'):
            self.start('robot_simulator', '__name:=' + name, '_images:=false')
        begin = self.start('scan_image_fusion', '__name:=crowded_fusion')
        self.expect_named(begin, '/scan', '2 nodes publish it', 'rostopic info /scan',
                          node='/crowded_fusion')
        diagnostics = Recorder('/diagnostics', DiagnosticArray)

        def told(level, in_message):
            def holds(message):
                return any('crowded_fusion' in status.name and status.level == level and
                           in_message(status.message) for status in message.status)
            heard = len(diagnostics.messages)
            wait_for(lambda: any(holds(m) for m in diagnostics.messages[heard:]), 'diagnostics')
        told(DiagnosticStatus.WARN, lambda text: 'topic /scan' in text and '2 nodes' in text)
        wrong = self.nodes.pop(1)
        wrong.send_signal(signal.SIGINT)
        self.assertEqual(wrong.wait(30), 0)
        told(DiagnosticStatus.WARN, lambda text: '2 nodes' not in text)  # but there is no camera

    def test_the_clock_of_a_recording(self):
        rospy.set_param('/use_sim_time', True)
        try:
            self.start('bounded_icp', '__name:=clockless')
            self.console.said('use_sim_time', '/clock', node='/clockless', count=2)
        finally:
            rospy.delete_param('/use_sim_time')

    def test_a_recording_that_is_played_by_the_clock_of_today(self):
        self.start('scan_image_fusion', '__name:=late_fusion', 'scan:=late/scan')
        scan = publisher('late/scan', LaserScan)
        wait_subscribed(scan)
        time = [START]

        def told():
            time[0] += 0.05
            scan.publish(room_scan(time[0]))
            rospy.sleep(0.05)
            return self.console.found('clock of /late/scan', 'is a bag played?', 'use_sim_time',
                                      node='/late_fusion')
        wait_for(told, 'the age of the stamps to be told')

    def test_the_transform_of_encoders(self):
        self.start('bounded_icp', '__name:=wheel_icp', '_odom_source:=tf', '_odom_frame:=wheels')
        self.console.said('encoders: no transform wheels -> base_link', node='/wheel_icp', count=2)
        self.drive_by_transforms('wheels', lambda: self.console.found(
            'encoders: all right now', node='/wheel_icp'))
        self.console.said('encoders: no new transform wheels -> base_link', node='/wheel_icp')

    def test_encoders_by_a_transform_need_no_topic(self):
        self.start('bounded_icp', '__name:=tf_icp', 'odom:=nobody/odom', '_odom_frame:=tf_odom')
        self.console.said('waiting for topic /nobody/odom', node='/tf_icp')
        diagnostics = Recorder('/diagnostics', DiagnosticArray)

        def silent():
            status = [s for m in diagnostics.messages[-20:] for s in m.status if 'tf_icp' in s.name]
            return status and '/nobody/odom' not in status[-1].message
        self.drive_by_transforms('tf_odom', silent)

    def drive_by_transforms(self, frame, until):
        encoders = publisher('/tf', TFMessage)
        wait_subscribed(encoders)
        time = [START]

        def drive():
            time[0] += 0.05
            encoders.publish([transform(frame, 'base_link', stamp=time[0])])
            rospy.sleep(0.05)
            return until()
        wait_for(drive, 'the encoders of ' + frame)
        encoders.unregister()

    def test_a_transform_until_it_is_there(self):
        self.start('scan_image_fusion', '__name:=blind_fusion', 'icp_model:=blind/icp_model',
                   'scan:=blind/scan', 'odom:=blind/odom')
        scan, odom = publisher('blind/scan', LaserScan), publisher('blind/odom', Odometry)
        models = Recorder('blind/icp_model', IcpModel).wait_connected()
        wait_subscribed(scan, odom)
        time = [START]

        def drive():
            time[0] += 0.05
            odom.publish(make_odometry(time[0]))
            scan.publish(room_scan(time[0]))
            rospy.sleep(0.05)

        begin = rospy.get_time()

        def named():
            drive()
            return [m for m in self.console.messages if m.name == '/blind_fusion' and
                    'laser transform: no transform base_link -> laser' in m.msg]
        wait_for(lambda: len(named()) >= 3, 'the transform to be named again')
        self.assertLess(named()[0].header.stamp.to_sec() - begin, 5.0)
        self.assertFalse(models.messages, 'a pose of the laser was invented')
        static = static_transforms(transform('base_link', 'laser', 0.25, 0, 0.3))
        wait_for(lambda: (drive(), models.messages)[1], 'models')
        self.assertAlmostEqual(models.messages[0].laser_x, 0.25)
        self.console.said('laser transform: all right now', node='/blind_fusion')
        named_before = len(named())
        end = rospy.get_time() + 6.0  # a whole period of naming
        wait_for(lambda: (drive(), rospy.get_time() > end)[1], 'the time to pass')
        self.assertEqual(len(named()), named_before, 'it is named although it is there')
        static.unregister()


if __name__ == '__main__':
    rostest.rosrun('scan_image_slam', 'missing_inputs', MissingInputsTest)
