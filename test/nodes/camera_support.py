"""A robot with laser, encoders and camera whose messages are made by hand: what tests feed
scan_image_fusion with."""

import unittest

import rospy
from live_support import (START, Console, Recorder, optical_transform, publisher,
                          static_transforms, transform, wait_subscribed)
from nav_msgs.msg import Odometry
from scan_image_slam.msg import IcpModel
from sensor_msgs.msg import CameraInfo, Image, LaserScan


class CameraTest(unittest.TestCase):
    """Publishers of the node's inputs, and recorders of what it says."""
    MOUNTS = (transform('base_link', 'laser', 0, 0, 0.3),
              optical_transform('base_link', 'camera', 0, 0, 0.5))

    @classmethod
    def setUpClass(cls):
        rospy.init_node('camera_test')
        cls.static = static_transforms(*cls.MOUNTS)
        cls.scan = publisher('scan', LaserScan)
        cls.odom = publisher('odom', Odometry)
        cls.info = publisher('camera_info', CameraInfo)
        cls.image = publisher('image_raw', Image)
        cls.console = Console()
        cls.models = Recorder('icp_model', IcpModel).wait_connected()
        wait_subscribed(cls.scan, cls.odom, cls.info, cls.image)
        cls.time = START
