#!/usr/bin/env python3
"""Fails, and says what to do, if a package or its program is not installed. Launch files run it as
the command of a parameter: before they start anything."""
import argparse
import sys

import roslib.packages
import rospkg


def problem(package, program):
    try:
        path = rospkg.RosPack().get_path(package)
    except rospkg.ResourceNotFound:
        return 'package %s is not installed' % package
    if program and not roslib.packages.find_node(package, program):
        return 'package %s in %s has no program %s: it is not built' % (package, path, program)
    return ''


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('package')
    parser.add_argument('program', nargs='?')
    parser.add_argument('--or', dest='otherwise', metavar='ARGUMENT',
                        help='argument of the launch file that does without')
    arguments = parser.parse_args()
    found = problem(arguments.package, arguments.program)
    if not found:
        print(arguments.package)
        return 0
    advice = [
        'with the ROS packages of Ubuntu: sudo apt install ros-noetic-%s'
        % arguments.package.replace('_', '-'),
        'elsewhere: its sources into the src folder of your catkin workspace, and build them']
    if arguments.otherwise:
        advice.append('or without it: %s' % arguments.otherwise)
    print('\n  '.join(['scan_image_slam: ' + found] + advice), file=sys.stderr)
    return 1


if __name__ == '__main__':
    sys.exit(main())
