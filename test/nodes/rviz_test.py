#!/usr/bin/env python3
"""rviz with the package's layout, on a screen in memory: the map is in the picture, the panel works."""

import ctypes
import os
import shutil
import signal
import subprocess
import unittest

import cv2
import numpy
import rospkg
import rospy
import rostest
from geometry_msgs.msg import Pose2D
from live_support import START, WALLS, make_model, publisher, stamp_of, transform, wait_for
from live_support import wait_subscribed
from scan_image_slam.msg import IcpModel, ScanMatch
from tf2_msgs.msg import TFMessage

LAYOUT = os.path.join(rospkg.RosPack().get_path('scan_image_slam'), 'rviz', 'slam.rviz')
SCALE = 45.0  # of the layout [px/m]


def end_with_parent():
    """For a child process: no window is left behind, however the test ends."""
    kill_with_parent = 1  # PR_SET_PDEATHSIG
    ctypes.CDLL(None).prctl(kill_with_parent, signal.SIGKILL)


class Screen:
    """An X server without a screen."""

    def __init__(self):
        reading, writing = os.pipe()
        self._server = subprocess.Popen(
            ['Xvfb', '-displayfd', str(writing), '-screen', '0', '1600x1000x24', '-nolisten',
             'tcp'], pass_fds=[writing], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            preexec_fn=end_with_parent)
        os.close(writing)
        with os.fdopen(reading) as pipe:
            self.name = ':' + pipe.readline().strip()

    def environment(self):
        return dict(os.environ, DISPLAY=self.name, LIBGL_ALWAYS_SOFTWARE='1',
                    QT_X11_NO_MITSHM='1')

    def picture(self):
        """All that is to be seen, blue, green, red."""
        png = subprocess.run(['import', '-window', 'root', 'png:-'], stdout=subprocess.PIPE,
                             env=self.environment(), check=True, timeout=60).stdout
        return cv2.imdecode(numpy.frombuffer(png, numpy.uint8), cv2.IMREAD_COLOR)

    def close(self):
        self._server.kill()
        self._server.wait()


UNKNOWN = numpy.array((0x86, 0x89, 0x70))  # colour of rviz for cells of which nothing is known


def largest(mask):
    """Bounding box of the largest area: x, y, width, height; without size if there is none."""
    if mask.size == 0:
        return (0, 0, 0, 0)
    count, _, boxes, _ = cv2.connectedComponentsWithStats(mask)
    return max((tuple(int(v) for v in box) for box in boxes[1:count]), key=lambda box: box[4],
               default=(0, 0, 0, 0, 0))[:4]


def known_part(picture):
    """Bounding box of what is known, inside of the area of which nothing is known."""
    unknown = cv2.inRange(picture, tuple(int(v) for v in UNKNOWN - 8),
                          tuple(int(v) for v in UNKNOWN + 8))
    # The lines of the layout's grid cross it.
    unknown = cv2.morphologyEx(unknown, cv2.MORPH_CLOSE, numpy.ones((5, 5), numpy.uint8))
    x, y, width, height = largest(unknown)
    inner_x, inner_y, *size = largest(255 - unknown[y:y + height, x:x + width])
    return (x + inner_x, y + inner_y, *size)


class RvizTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        for tool in ('Xvfb', 'import', 'rviz'):
            if shutil.which(tool) is None:
                raise unittest.SkipTest(tool + ' is not installed')
        rospy.init_node('rviz_test')
        cls.screen = Screen()
        cls.rviz = subprocess.Popen(['rviz', '-d', LAYOUT], env=cls.screen.environment(),
                                    stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                    preexec_fn=end_with_parent)

    @classmethod
    def tearDownClass(cls):
        cls.rviz.kill()
        cls.rviz.wait()
        cls.screen.close()

    def build_map(self):
        """Three scans from places in the room where nothing but the walls is in the way."""
        model, match = publisher('icp_model', IcpModel), publisher('scan_match', ScanMatch)
        wait_subscribed(model, match)
        for i in range(3):
            message = ScanMatch()
            message.header.stamp = stamp_of(START + i)
            message.header.frame_id = 'base_link'
            message.start_stamp = message.reference_stamp = stamp_of(START)
            message.motion = Pose2D(0.3 * i, 0.0, 0.0)
            message.status = ScanMatch.STATUS_MATCHED
            message.has_odometry = True
            message.odom_pose = message.motion
            model.publish(make_model(START + i, (0.3 * i, 0.0, 0.0), beams=1440))
            match.publish(message)

    def test_the_map_is_to_be_seen(self):
        transforms = publisher('/tf', TFMessage)
        self.build_map()
        last = []

        def seen():
            self.assertIsNone(self.rviz.poll(), 'rviz has ended')
            transforms.publish(TFMessage(
                transforms=[transform('odom', 'base_link', stamp=rospy.get_time())]))
            last[:] = [self.screen.picture()]
            return self.is_room(last[0])
        try:
            wait_for(seen, lambda: f'the room in the picture; known is {known_part(last[0])}', 120)
        finally:
            folder = os.environ.get('SCAN_IMAGE_SLAM_TEST_PICTURES')
            if folder and last:
                cv2.imwrite(os.path.join(folder, 'rviz.png'), last[0])

    def test_the_panel_is_loaded(self):
        def heard():
            subscribers = rospy.get_master().getSystemState()[2][1]
            return any(topic == '/diagnostics' and any(node.startswith('/rviz') for node in nodes)
                       for topic, nodes in subscribers)
        wait_for(heard, 'a subscription of the panel', 120)

    def is_room(self, picture):
        """What is known has the room's size; it is light, with dark walls around it."""
        x, y, width, height = known_part(picture)
        # The view looks down with x to the right; the walls are one or two cells thick.
        for pixels, metres in ((width, WALLS[1] - WALLS[0]), (height, WALLS[3] - WALLS[2])):
            if not SCALE * metres - 5 <= pixels <= SCALE * (metres + 0.1) + 5:
                return False
        room = picture[y:y + height, x:x + width].max(axis=2)
        if numpy.mean(room > 150) < 0.9:
            return False
        # A quarter along each side, where no name of a frame is, a dark line lies at the border.
        thick = int(0.1 * SCALE) + 5
        row, column = room[height // 4], room[:, 3 * width // 4]
        return all(side.min() < 60 for side in (row[:thick], row[-thick:], column[:thick],
                                                column[-thick:]))


if __name__ == '__main__':
    rostest.rosrun('scan_image_slam', 'rviz', RvizTest)
