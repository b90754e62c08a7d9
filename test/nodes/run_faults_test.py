#!/usr/bin/env python3
"""What goes wrong while a robot drives: inputs stop and come back, nodes die, the machine is busy.

After each fault the pose is again that of the robot, counted from the same beginning."""

import os
import signal
import time
import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped
from live_support import Console, Recorder, process_of, wait_for
from nav_msgs.msg import Odometry
from pose_support import compared, off_by
from scan_image_slam.msg import IcpModel, ScanMatch
from sensor_msgs.msg import CameraInfo, Image, LaserScan

TOPICS = {'scan': LaserScan, 'odom': Odometry, 'image_raw': Image, 'camera_info': CameraInfo}
MAX_ERROR = 0.05  # [m]
SILENCE = 2.5     # after which an input is missed [s]


class Relay:
    """A driver that can be stopped and started again: hands a topic of the robot on."""

    def __init__(self, topic, message_type):
        self._topic, self._type = topic, message_type
        self.start()
        rospy.Subscriber('robot/' + topic, message_type, self._hand_on, queue_size=10)

    def start(self):
        self._publisher = rospy.Publisher(self._topic, self._type, queue_size=10)

    def stop(self):
        publisher, self._publisher = self._publisher, None
        publisher.unregister()

    def _hand_on(self, message):
        publisher = self._publisher
        if publisher:
            try:
                publisher.publish(message)
            except rospy.ROSException:  # stopped meanwhile
                pass


class RunFaultsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('run_faults_test')
        cls.console = Console()
        cls.diagnostics = Recorder('/diagnostics', DiagnosticArray)
        cls.truths = Recorder('ground_truth', PoseStamped)
        cls.poses = Recorder('pose', PoseWithCovarianceStamped)
        cls.models = Recorder('icp_model', IcpModel, key=lambda m: m.has_image)
        cls.modes = Recorder('scan_match', ScanMatch, key=lambda m: m.mode)
        cls.truths.wait_connected()
        cls.relays = {topic: Relay(topic, kind) for topic, kind in TOPICS.items()}
        cls.first = wait_for(cls.compared_since, 'a pose')[0]

    @classmethod
    def compared_since(cls, count=0):
        """True poses and poses, without the first `count` that were told."""
        return compared(cls.truths.messages, cls.poses.messages[count:])

    def expect_right_again(self, what):
        """New poses come, and the robot is where they say."""
        before = len(self.poses.messages)
        wait_for(lambda: len(self.poses.messages) > before + 20, 'poses after ' + what)
        error = off_by(self.first, wait_for(lambda: self.compared_since(before), 'truth')[-1])
        print(f'{what}: off by {1e3 * error:.1f} mm')
        self.assertLess(error, MAX_ERROR, what)

    def stop_and_start(self, topic):
        heard = len(self.console.messages)
        self.relays[topic].stop()
        time.sleep(SILENCE)
        self.console.said('/' + topic, node='/scan_image_fusion', after=heard)
        self.relays[topic].start()
        self.expect_right_again(topic + ' back')

    def test_scans_stop_and_come_back(self):
        heard = len(self.diagnostics.messages)
        self.stop_and_start('scan')
        modes = [value.value for m in self.diagnostics.messages[heard:] for status in m.status
                 if 'bounded_icp' in status.name for value in status.values if value.key == 'mode']
        self.assertIn('coasting', modes)

    def test_encoders_stop_and_come_back(self):
        self.stop_and_start('odom')
        count = len(self.modes.messages)
        wait_for(lambda: ScanMatch.MODE_FULL in self.modes.messages[count:], 'encoders to be used')

    def test_camera_stops_and_comes_back(self):
        for topic in ('image_raw', 'camera_info'):
            self.stop_and_start(topic)
            count = len(self.models.messages)
            wait_for(lambda: any(self.models.messages[count:]), 'images to be fused')

    def expect_another_process(self, node):
        old = process_of(node)
        os.kill(old, signal.SIGKILL)

        def is_new():
            try:
                return process_of(node) != old
            except OSError:
                return False
        wait_for(is_new, node + ' to be started again')
        self.expect_right_again(node + ' killed')

    def test_fusion_is_killed(self):
        self.expect_another_process('/scan_image_fusion')

    def test_matching_is_killed(self):
        self.expect_another_process('/bounded_icp')

    def left_out(self):
        """By bounded_icp, as its diagnostics tell: messages, and whether they warn."""
        for array in reversed(self.diagnostics.messages):
            for status in array.status:
                if status.name.startswith('bounded_icp'):
                    values = {v.key: v.value for v in status.values}
                    return (int(values['/icp_model left out']),
                            status.level == DiagnosticStatus.WARN and 'left out' in status.message)
        return (0, False)

    def test_too_little_time(self):
        """A node that has its processor for 5 of 305 ms leaves out what it can't do, and says so."""
        pid = process_of('/bounded_icp')
        before = self.left_out()[0]
        end = time.monotonic() + 6.0
        while time.monotonic() < end:
            os.kill(pid, signal.SIGSTOP)
            time.sleep(0.3)
            os.kill(pid, signal.SIGCONT)
            time.sleep(0.005)
        count, _ = wait_for(lambda: self.left_out()[1] and self.left_out(), 'a warning')
        self.assertGreater(count, before)
        self.expect_right_again('a busy machine')
        # It is up to date again.
        newest = self.poses.messages[-1].header.stamp
        self.assertLess((rospy.Time.now() - newest).to_sec(), 1.0)
        wait_for(lambda: not self.left_out()[1], 'the warning to end')


if __name__ == '__main__':
    rostest.rosrun('scan_image_slam', 'run_faults', RunFaultsTest)
