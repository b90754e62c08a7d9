"""A robot that maps a room by hand-made scans and matches: what tests feed a mapper with."""

import math

import numpy
from geometry_msgs.msg import Pose2D, PoseWithCovarianceStamped
from live_support import START, Recorder, publisher, stamp_of, wait_for
from pose_support import compose, inverse
from scan_image_slam.msg import IcpModel, ScanMatch

PERIOD = 0.1  # [s]
BEAMS = 720
# A room that is another one when it is turned by any angle.
CORNERS = numpy.array([(-4, -3), (4, -3), (4, 0), (1, 0), (1, 3), (-2, 3), (-4, 1)], float)
FIRST = (-3.0, -2.0, 0.0)  # where the first drive begins, in the room


def model_of(seconds, pose, scale=1.0):
    """What scan_image_fusion makes of a scan from `pose` in the room, or in one of another scale."""
    bearings = -math.pi + 2 * math.pi / BEAMS * numpy.arange(BEAMS)
    rays = numpy.stack([numpy.cos(pose[2] + bearings), numpy.sin(pose[2] + bearings)], 1)
    ranges = numpy.full(BEAMS, numpy.inf)
    for a, b in zip(CORNERS, numpy.roll(CORNERS, -1, axis=0)):
        along, start = b - a, a - numpy.array(pose[:2])
        determinant = rays[:, 0] * along[1] - rays[:, 1] * along[0]
        with numpy.errstate(divide='ignore', invalid='ignore'):
            distance = (start[0] * along[1] - start[1] * along[0]) / determinant
            share = (start[0] * rays[:, 1] - start[1] * rays[:, 0]) / determinant
        hit = (distance > 0) & (share >= 0) & (share <= 1)
        ranges = numpy.where(hit, numpy.minimum(ranges, scale * distance), ranges)
    model = IcpModel()
    model.header.stamp = stamp_of(seconds)
    model.header.frame_id = 'base_link'
    model.bearings = bearings.tolist()
    model.ranges = ranges.tolist()
    model.points_x = (ranges * numpy.cos(bearings)).tolist()
    model.points_y = (ranges * numpy.sin(bearings)).tolist()
    model.time_offsets = model.edge_weights = [0.0] * BEAMS
    model.edge_signs = [0] * BEAMS
    return model


class Robot:
    """Feeds one mapper with drives through the room."""

    def __init__(self, space):
        self.space = space
        self.model = publisher(space + 'icp_model', IcpModel)
        self.match = publisher(space + 'scan_match', ScanMatch)
        self.initial_pose = publisher(space + 'initialpose', PoseWithCovarianceStamped)
        self.poses = Recorder(space + 'pose', PoseWithCovarianceStamped)
        self.time = START
        self.scale = 1.0  # of the room

    def wait_for_mapper(self):
        wait_for(lambda: self.poses.connected() and self.initial_pose.get_num_connections() > 0 and
                 min(self.model.get_num_connections(), self.match.get_num_connections()) > 0,
                 'the mapper of ' + self.space)

    def begin(self, pose):
        """A new chain of matches, from `pose` in the room."""
        self.time += 10.0
        self.start_time, self.start, self.pose = self.time, pose, pose

    def scan(self, motion=(0.0, 0.0, 0.0)):
        """Drives on and sends what is seen there."""
        self.pose = compose(self.pose, motion)
        match = ScanMatch()
        match.header.stamp = stamp_of(self.time)
        match.header.frame_id = 'base_link'
        match.start_stamp = match.reference_stamp = stamp_of(self.start_time)
        match.motion = Pose2D(*compose(inverse(self.start), self.pose))
        match.covariance = [1e-4, 0, 0, 0, 1e-4, 0, 0, 0, 1e-6]
        match.status = ScanMatch.STATUS_MATCHED
        self.model.publish(model_of(self.time, self.pose, self.scale))
        self.match.publish(match)
        self.time += PERIOD

    def drive(self, count, motion=(0.1, 0.0, 0.0)):
        for _ in range(count):
            self.scan(motion)
            self.poses.at(self.time - PERIOD)

    def map_whole_room(self):
        self.begin(FIRST)
        self.drive(1, (0.0, 0.0, 0.0))
        self.drive(50)
        self.drive(16, (0.05, 0.0, math.pi / 16))
        self.drive(20)

    def poses_between(self, begin, end=math.inf):
        """Of the scans from `begin` until before `end` [s]."""
        return [m for m in self.poses.messages
                if begin - 1e-6 < m.header.stamp.to_sec() < end - 1e-6]

    def find(self):
        """Stands and looks until there is a pose; gives it."""
        begin = self.time

        def found():
            self.scan()
            return self.poses_between(begin)
        return wait_for(found, 'the robot to be found')[-1]

    def expected(self):
        """Where the robot is in the map, which began at FIRST."""
        return compose(inverse(FIRST), self.pose)
