#!/usr/bin/env python3
"""The master dies and is started anew: the nodes go on with each other, and say what is wrong."""

import os
import signal
import socket
import subprocess
import tempfile
import unittest

import rosgraph
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseWithCovarianceStamped
from live_support import (DEADLINE, START, Recorder, make_odometry, program, publisher, room_scan,
                          static_transforms, transform, wait_for, wait_subscribed)
from nav_msgs.msg import Odometry
from sensor_msgs.msg import LaserScan

NODES = ('scan_image_fusion', 'bounded_icp', 'mapper')


def listen(port=0):
    server = socket.socket()
    server.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    server.settimeout(DEADLINE)
    server.bind(('', port))
    server.listen(100)
    return server


class Master:
    def __init__(self):
        with listen() as server:
            self.port = server.getsockname()[1]
        os.environ['ROS_MASTER_URI'] = f'http://localhost:{self.port}'

    def start(self):
        self._process = subprocess.Popen(['rosmaster', '--core', '-p', str(self.port)],
                                         stdout=subprocess.DEVNULL)
        wait_for(rosgraph.is_master_online, 'the master')

    def kill(self):
        self._process.kill()
        self._process.wait()


class MasterRestartTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.master = Master()
        cls.master.start()
        rospy.init_node('master_restart_test')
        cls.static = static_transforms(transform('base_link', 'laser', 0, 0, 0.3))
        cls.scan = publisher('scan', LaserScan)
        cls.odom = publisher('odom', Odometry)
        cls.diagnostics = Recorder('/diagnostics', DiagnosticArray)
        cls.poses = Recorder('pose', PoseWithCovarianceStamped)
        cls.output = tempfile.NamedTemporaryFile()
        rospy.set_param('scan_image_fusion/use_camera', False)
        cls.nodes = [subprocess.Popen([program(name)], stdout=cls.output, stderr=subprocess.STDOUT)
                     for name in NODES]
        cls.poses.wait_connected()
        wait_for(lambda: cls.odom.get_num_connections() == 2, 'both readers of odom')
        wait_subscribed(cls.scan)
        cls.time = START

        def is_seen():
            cls.send()
            rospy.sleep(0.1)
            return cls.poses.messages
        wait_for(is_seen, 'the first pose')

    @classmethod
    def tearDownClass(cls):
        for node in cls.nodes:
            node.kill()
        cls.master.kill()
        cls.output.close()

    @classmethod
    def send(cls):
        cls.time += 0.025
        cls.odom.publish(make_odometry(cls.time))
        cls.scan.publish(room_scan(cls.time))

    def said(self):
        """What the nodes have on their consoles."""
        with open(self.output.name) as file:
            return file.read()

    def expect_poses(self):
        for _ in range(10):
            self.send()
            self.poses.at(self.time)

    def expect_told(self, *words):
        heard = len(self.diagnostics.messages)

        def told(name):
            return any(status.name == name + ': inputs' and status.level > 0 and
                       all(word in status.message for word in words)
                       for message in self.diagnostics.messages[heard:]
                       for status in message.status)
        for name in NODES:
            wait_for(lambda name=name: told(name), f'{name} to tell of the master')

    def test_the_nodes_go_on_and_say_what_is_wrong(self):
        uri = f'http://localhost:{self.master.port}'
        self.expect_poses()
        self.master.kill()
        # Where a link is cut there is not even a refusal: nobody waits for the answer.
        with listen(self.master.port) as mute:
            asked = [mute.accept()[0] for _ in NODES]
            self.expect_poses()
        for connection in asked:
            connection.close()
        self.expect_told(uri, 'does not answer')
        self.expect_poses()
        self.master.start()
        self.expect_told(uri, 'was started anew', 'Restart the launch')
        self.expect_poses()
        wait_for(lambda: self.said().count('was started anew') >= 3, 'the consoles to say it, too')
        for node in self.nodes:
            node.send_signal(signal.SIGINT)
        self.assertEqual([node.wait(30) for node in self.nodes], [0, 0, 0])


if __name__ == '__main__':
    rostest.rosrun('scan_image_slam', 'master_restart', MasterRestartTest)
