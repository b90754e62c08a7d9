"""What the live tests share: hand-made messages of a robot in a room; waiting for conditions."""

import math
import os
import signal
import subprocess
import threading
import time
from xmlrpc.client import ServerProxy

import numpy
import rospy
from geometry_msgs.msg import TransformStamped
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Log
from sensor_msgs.msg import CameraInfo, Image, LaserScan
from std_srvs.srv import SetBool
from tf2_msgs.msg import TFMessage

DEADLINE = 60.0  # [s]; generous, because it is only waited for in vain if a test fails
PLAY_RATE = os.environ.get('SCAN_IMAGE_SLAM_PLAY_RATE', '1')  # nodes with sanitizers are slow
START = 1000.0  # first stamp of hand-made messages [s]
WALLS = (-3.0, 5.0, -2.0, 4.0)  # of the room: min_x, max_x, min_y, max_y [m]


def wait_for(condition, what, deadline=DEADLINE):
    """Returns what `condition` gives once it is true; fails, saying `what`, if it never is."""
    end = time.monotonic() + deadline
    while time.monotonic() < end:
        result = condition()
        if result:
            return result
        time.sleep(0.02)
    raise AssertionError('waited in vain for ' + (what() if callable(what) else what))


class Recorder:
    """Keeps all messages of a topic."""

    def __init__(self, topic, message_type, key=None):
        self._lock = threading.Lock()
        self._messages = []
        self._key = key or (lambda message: message)
        self.topic = topic
        self._subscriber = rospy.Subscriber(topic, message_type, self._add, queue_size=10000)

    def _add(self, message):
        with self._lock:
            self._messages.append(self._key(message))

    @property
    def messages(self):
        with self._lock:
            return list(self._messages)

    def connected(self):
        return self._subscriber.get_num_connections() > 0

    def wait_connected(self):
        wait_for(self.connected, 'a publisher of ' + self.topic)
        return self

    def find(self, condition, what='a message', deadline=DEADLINE):
        """The first message for which the condition holds."""
        return wait_for(lambda: next((m for m in self.messages if condition(m)), None),
                        f'{what} on {self.topic} ({len(self.messages)} came)', deadline)

    def at(self, stamp):
        """The message with this stamp [s]."""
        return self.find(lambda m: abs(m.header.stamp.to_sec() - stamp) < 1e-6,
                         f'a message with the stamp {stamp}')


class Console(Recorder):
    """What nodes say, at the level of information or above."""

    def __init__(self):
        super().__init__('/rosout', Log)

    def found(self, *words, node=None, after=0):
        """Messages that hold all words; only those from index `after` on count."""
        return [m for m in self.messages[after:]
                if all(w in m.msg for w in words) and (node is None or m.name == node)]

    def said(self, *words, node=None, count=1, after=0):
        """Waits until `count` messages are found."""
        def enough():
            messages = self.found(*words, node=node, after=after)
            return messages if len(messages) >= count else None
        return wait_for(enough, lambda: f'{count} x {words} on the console; it says ' +
                        str([m.msg for m in self.messages[after:]][-20:]))


def stamp_of(seconds):
    return rospy.Time.from_sec(round(seconds, 9))


def yaw_quaternion(message, yaw, roll=0.0):
    """Sets an orientation: roll about x, then yaw about z."""
    message.x = math.sin(roll / 2) * math.cos(yaw / 2)
    message.y = math.sin(roll / 2) * math.sin(yaw / 2)
    message.z = math.cos(roll / 2) * math.sin(yaw / 2)
    message.w = math.cos(roll / 2) * math.cos(yaw / 2)


def transform(parent, child, x=0.0, y=0.0, z=0.0, yaw=0.0, roll=0.0, stamp=START):
    message = TransformStamped()
    message.header.stamp = stamp_of(stamp)
    message.header.frame_id = parent
    message.child_frame_id = child
    message.transform.translation.x = x
    message.transform.translation.y = y
    message.transform.translation.z = z
    yaw_quaternion(message.transform.rotation, yaw, roll)
    return message


def optical_transform(parent, child, x=0.0, y=0.0, z=0.0):
    """Of a camera that looks along x."""
    message = transform(parent, child, x, y, z)
    q = message.transform.rotation
    q.x, q.y, q.z, q.w = -0.5, 0.5, -0.5, 0.5
    return message


def cast(x, y, heading):
    """Distance to the walls of the room along rays, from inside [m]."""
    heading = numpy.asarray(heading, dtype=float)
    min_x, max_x, min_y, max_y = WALLS
    dx, dy = numpy.cos(heading), numpy.sin(heading)
    with numpy.errstate(divide='ignore'):
        to_x = numpy.where(dx > 0, (max_x - x) / dx, (min_x - x) / dx)
        to_y = numpy.where(dy > 0, (max_y - y) / dy, (min_y - y) / dy)
    return numpy.minimum(numpy.where(numpy.abs(dx) < 1e-12, numpy.inf, to_x),
                         numpy.where(numpy.abs(dy) < 1e-12, numpy.inf, to_y))


def make_scan(seconds, ranges, angle_min=-math.pi, increment=2 * math.pi / 360, frame='laser'):
    scan = LaserScan()
    scan.header.stamp = stamp_of(seconds)
    scan.header.frame_id = frame
    scan.angle_min = angle_min
    scan.angle_increment = increment
    scan.angle_max = angle_min + increment * (len(ranges) - 1)
    scan.range_min = 0.1
    scan.range_max = 30.0
    scan.ranges = [float(r) for r in ranges]
    return scan


def room_scan(seconds, pose=(0.0, 0.0, 0.0), beams=360, **kwargs):
    """What a laser at `pose` (x, y, heading) in the room measures."""
    increment = 2 * math.pi / beams
    bearings = -math.pi + increment * numpy.arange(beams)
    return make_scan(seconds, cast(pose[0], pose[1], pose[2] + bearings), increment=increment,
                     **kwargs)


def make_odometry(seconds, x=0.0, y=0.0, yaw=0.0):
    message = Odometry()
    message.header.stamp = stamp_of(seconds)
    message.header.frame_id = 'odom'
    message.child_frame_id = 'base_link'
    message.pose.pose.position.x = x
    message.pose.pose.position.y = y
    yaw_quaternion(message.pose.pose.orientation, yaw)
    return message


FOCAL, WIDTH, HEIGHT = 300.0, 320, 240


def make_camera_info(seconds, focal=FOCAL, width=WIDTH, height=HEIGHT, frame='camera'):
    info = CameraInfo()
    info.header.stamp = stamp_of(seconds)
    info.header.frame_id = frame
    info.width, info.height = width, height
    info.distortion_model = 'plumb_bob'
    info.D = [0.0] * 5
    info.K = [focal, 0, width / 2, 0, focal, height / 2, 0, 0, 1 if focal else 0]
    info.R = [1, 0, 0, 0, 1, 0, 0, 0, 1]
    info.P = [focal, 0, width / 2, 0, 0, focal, height / 2, 0, 0, 0, 1, 0]
    return info


def make_image(seconds, pixels, encoding='mono8', frame='camera'):
    """`pixels`: an array of height x width, or height x width x channels."""
    image = Image()
    image.header.stamp = stamp_of(seconds)
    image.header.frame_id = frame
    image.height, image.width = pixels.shape[:2]
    image.encoding = encoding
    image.is_bigendian = 0
    image.step = pixels.strides[0]
    image.data = pixels.tobytes()
    return image


def publisher(topic, message_type, latch=False):
    return rospy.Publisher(topic, message_type, queue_size=100, latch=latch)


def wait_subscribed(*publishers):
    for one in publishers:
        wait_for(lambda one=one: one.get_num_connections() > 0, 'a subscriber of ' + one.name)


def process_of(node):
    """Its number."""
    return ServerProxy(rospy.get_master().lookupNode(node)[2]).getPid('/test')[2]


def static_transforms(*transforms):
    """The publisher must be kept, because it latches."""
    static = publisher('/tf_static', TFMessage, latch=True)
    static.publish(TFMessage(transforms=list(transforms)))
    return static


def program(name):
    """Path of one of the package's programs."""
    import roslib.packages
    found = roslib.packages.find_node('scan_image_slam', name)
    if not found:
        raise AssertionError('the package has no program ' + name)
    return found[0]


def expect_up_and_down(name, *arguments):
    """Node NAME of that full name comes up, and ends in order when it is told to; gives what it
    said."""
    space, _, base = name.rpartition('/')
    process = subprocess.Popen([program(base), '__ns:=' + (space or '/'), *arguments],
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)

    def is_up():
        if process.poll() is not None:
            raise AssertionError(f'{name} has ended with {process.returncode}')
        publishers = rospy.get_master().getSystemState()[2][0]
        return any(name in nodes for topic, nodes in publishers if topic != '/rosout')
    try:
        wait_for(is_up, 'the node ' + name)
    finally:
        process.send_signal(signal.SIGINT)
        output, _ = process.communicate(timeout=60)
    if process.returncode != 0:
        raise AssertionError(f'{name} ended with {process.returncode}: {output}')
    return output


def run(*command):
    """Runs a program to its end; fails with what it said if it fails."""
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode != 0:
        raise AssertionError(f'{command} ended with {done.returncode}: {done.stdout}')
    return done.stdout


def simulate(folder, name, *options):
    bag = os.path.join(folder, name + '.bag')
    run(program('simulate'), '--out', bag, *options)
    return bag


def read_tum(path):
    """{stamp [ns]: (x, y, yaw)} of a trajectory file."""
    poses = {}
    with open(path) as file:
        for line in file:
            words = line.split()
            seconds, _, fraction = words[0].partition('.')
            stamp = int(seconds) * 10**9 + int(fraction.ljust(9, '0'))
            x, y, _, _, _, qz, qw = (float(w) for w in words[1:])
            poses[stamp] = (x, y, 2 * math.atan2(qz, qw))
    return poses


def make_model(seconds, pose=(0.0, 0.0, 0.0), beams=360):
    """What scan_image_fusion makes of room_scan(seconds, pose) with a laser in the middle."""
    from scan_image_slam.msg import IcpModel
    bearings = -math.pi + 2 * math.pi / beams * numpy.arange(beams)
    ranges = cast(pose[0], pose[1], pose[2] + bearings)
    model = IcpModel()
    model.header.stamp = stamp_of(seconds)
    model.header.frame_id = 'base_link'
    model.bearings = bearings.tolist()
    model.ranges = ranges.tolist()
    model.time_offsets = [0.0] * beams
    model.points_x = (ranges * numpy.cos(bearings)).tolist()
    model.points_y = (ranges * numpy.sin(bearings)).tolist()
    model.edge_weights = [0.0] * beams
    model.edge_signs = [0] * beams
    return model


class Player:
    """Plays a bag with its clock, once all readers have connected, so that nothing is missed."""

    NAME = 'player'

    def __init__(self, bag, readers, *options):
        """`readers`: pairs of node and topic."""
        self._process = subprocess.Popen(
            ['rosbag', 'play', '--clock', '--quiet', '--pause', '--rate', PLAY_RATE, *options, bag,
             '__name:=' + self.NAME], stdin=subprocess.DEVNULL)
        wait_for(lambda: set(readers) <= self._connections(), 'the nodes to hear the player')
        pause = rospy.ServiceProxy('/player/pause_playback', SetBool)
        pause.wait_for_service(DEADLINE)
        pause(False)

    def _connections(self):
        try:
            uri = rospy.get_master().lookupNode('/' + self.NAME)[2]
            info = ServerProxy(uri).getBusInfo('/test')[2]
        except OSError:
            return set()
        return {(entry[1].rstrip('/'), entry[4]) for entry in info if entry[2] == 'o'}

    def wait(self):
        if self._process.wait() != 0:
            raise AssertionError('rosbag play failed')

    def stop(self):
        self._process.send_signal(signal.SIGINT)
        self._process.wait(30)
