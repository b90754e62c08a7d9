"""Poses (x, y, yaw) [m, rad], and how far what the nodes tell is from the truth."""
import math


def yaw_of(orientation):
    return 2.0 * math.atan2(orientation.z, orientation.w)


def pose_of(pose):
    """(x, y, yaw) of a geometry_msgs/Pose."""
    return (pose.position.x, pose.position.y, yaw_of(pose.orientation))


def angle_difference(a, b):
    return (a - b + math.pi) % (2 * math.pi) - math.pi


def compose(a, b):
    """Of poses (x, y, yaw): b, told in the frame a, in the frame that a is told in."""
    c, s = math.cos(a[2]), math.sin(a[2])
    return (a[0] + c * b[0] - s * b[1], a[1] + s * b[0] + c * b[1], a[2] + b[2])


def inverse(pose):
    c, s = math.cos(pose[2]), math.sin(pose[2])
    return (-c * pose[0] - s * pose[1], s * pose[0] - c * pose[1], -pose[2])


def compared(truths, poses):
    """[(true pose in the world, pose in the map)] of the same moments, from what `ground_truth` and
    `pose` have told."""
    true = {m.header.stamp: pose_of(m.pose) for m in truths}
    return [(true[m.header.stamp], pose_of(m.pose.pose)) for m in poses if m.header.stamp in true]


def off_by(begin, now):
    """How far the pose is from the true one [m], if both agree at `begin`; each is (true, told)."""
    true, told = (compose(inverse(a), b) for a, b in zip(begin, now))
    return math.hypot(told[0] - true[0], told[1] - true[1])
