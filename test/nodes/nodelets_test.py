#!/usr/bin/env python3
"""The three nodes as nodelets of one manager: loaded, unloaded, loaded again while scans come."""

import os
import signal
import subprocess
import threading
import unittest
from xmlrpc.client import ServerProxy

import roslib.packages
import rospy
import rostest
from geometry_msgs.msg import PoseWithCovarianceStamped
from live_support import (START, Console, Recorder, make_odometry, publisher, room_scan,
                          static_transforms, transform, wait_for)
from nav_msgs.msg import Odometry
from sensor_msgs.msg import LaserScan

MANAGER = '/manager'
TYPES = {'scan_image_fusion': 'ScanImageFusionNodelet', 'bounded_icp': 'BoundedIcpNodelet',
         'mapper': 'MapperNodelet'}
OUTPUTS = {'scan_image_fusion': '/icp_model', 'bounded_icp': '/scan_match', 'mapper': '/pose'}
PERIOD = 0.025  # [s]


def manager():
    return ServerProxy(rospy.get_master().lookupNode(MANAGER)[2])


def published(topic):
    """Whether the manager publishes a topic."""
    publishers = rospy.get_master().getSystemState()[2][0]
    return any(name == topic and MANAGER in nodes for name, nodes in publishers)


class Loader:
    """Loads a nodelet, and unloads it when it is stopped."""

    def __init__(self, node, name=None):
        name = name or node
        tool = roslib.packages.find_node('nodelet', 'nodelet')[0]
        self._process = subprocess.Popen(
            [tool, 'load', 'scan_image_slam/' + TYPES[node], MANAGER, '__name:=' + name],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def wait(self):
        """Its exit code."""
        return self._process.wait(60)

    def stop(self):
        self._process.send_signal(signal.SIGINT)
        return self.wait()


class Drive(threading.Thread):
    """Scans and encoders of a robot that drives to and fro in the room, until it is stopped."""

    def __init__(self):
        super().__init__(daemon=True)
        self._static = static_transforms(transform('base_link', 'laser', z=0.3))
        self._scan = publisher('scan', LaserScan)
        self._odom = publisher('odom', Odometry)
        self._end = threading.Event()
        self.time = START

    def run(self):
        step = 0.01
        x = 0.0
        while not self._end.wait(PERIOD):
            step = -step if abs(x + step) > 1.0 else step
            x += step
            self._odom.publish(make_odometry(self.time, x))
            self._scan.publish(room_scan(self.time, (x, 0.0, 0.0)))
            self.time += PERIOD

    def stop(self):
        self._end.set()
        self.join()


class NodeletsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('nodelets_test')
        rospy.wait_for_service(MANAGER + '/load_nodelet', 60)
        cls.console = Console()
        cls.poses = Recorder('pose', PoseWithCovarianceStamped)
        cls.pid = manager().getPid('/nodelets_test')[2]

    def tearDown(self):
        self.assertEqual(manager().getPid('/nodelets_test')[2], self.pid, 'the manager has died')

    def start(self, *nodes):
        loaders = {node: Loader(node) for node in nodes}
        for node, loader in loaders.items():
            self.addCleanup(loader.stop)
            wait_for(lambda node=node: published(OUTPUTS[node]), 'the nodelet ' + node)
        return loaders

    def threads(self):
        return len(os.listdir(f'/proc/{self.pid}/task'))

    def wait_pose_of(self, stamp):
        self.poses.find(lambda m: m.header.stamp.to_sec() > stamp, f'a pose after {stamp}')

    def test_each_is_unloaded_and_loaded_again_while_scans_come(self):
        loaders = self.start(*TYPES)
        drive = Drive()
        drive.start()
        self.addCleanup(drive.stop)
        self.wait_pose_of(START)
        threads = []
        for node in list(TYPES) * 2:
            self.assertEqual(loaders[node].stop(), 0)
            wait_for(lambda: not published(OUTPUTS[node]), node + ' to go')
            self.assertEqual([other for other in TYPES if published(OUTPUTS[other])],
                             [other for other in TYPES if other != node])
            loaders.update(self.start(node))
            self.wait_pose_of(drive.time)
            threads.append(self.threads())
        self.assertEqual(threads, threads[:1] * len(threads), 'a thread is left behind')

    def test_they_talk_within_the_process(self):
        self.start(*TYPES)

        def talk():
            links = {(entry[4], entry[3]) for entry in manager().getBusInfo('/nodelets_test')[2]}
            return {(topic, 'INTRAPROCESS') for topic in ('/icp_model', '/scan_match')} <= links
        wait_for(talk, 'topics without a socket')

    def test_a_wrong_parameter_is_told_and_the_nodelet_is_not_loaded(self):
        for node, name, value, words in (
                ('scan_image_fusion', 'use_camera', 'no', 'of type string, expected is bool'),
                ('bounded_icp', 'window/min_distance', -1.0, 'is out of range'),
                ('mapper', 'reslution', 0.1, 'unknown parameter')):
            with self.subTest(node):
                full_name = f'/wrong_{node}/{name}'
                rospy.set_param(full_name, value)
                heard = len(self.console.messages)
                self.assertNotEqual(Loader(node, 'wrong_' + node).wait(), 0)
                self.console.said(full_name, words, node=MANAGER, after=heard)
                self.assertFalse(published(OUTPUTS[node]))


if __name__ == '__main__':
    rostest.rosrun('scan_image_slam', 'nodelets', NodeletsTest)
