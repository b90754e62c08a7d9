#!/usr/bin/env python3
"""The node mapper: maps that are saved, loaded, localised in, and saved by itself."""

import math
import os
import resource
import shutil
import signal
import subprocess
import threading
import unittest

import numpy
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseWithCovarianceStamped
from live_support import (Console, Recorder, process_of, program, wait_for,
                          yaw_quaternion)
from mapper_support import FIRST, PERIOD, Robot
from nav_msgs.srv import GetMap
from pose_support import angle_difference, compose, yaw_of
from scan_image_slam.srv import SaveMap, StateFile
from std_srvs.srv import Trigger


class MapperStateTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('mapper_state_test')
        cls.console = Console()
        cls.folder = rospy.get_param('mapper/map_folder')
        cls.saving_folder = rospy.get_param('saving/mapper/map_folder')
        cls.robot = Robot('')
        cls.robot.wait_for_mapper()
        for name in ('dynamic_map', 'reset', 'save_state', 'load_state'):
            rospy.wait_for_service(name, 60)
        cls.get_map = rospy.ServiceProxy('dynamic_map', GetMap)
        cls.reset = rospy.ServiceProxy('reset', Trigger)
        cls.save = rospy.ServiceProxy('save_state', StateFile)
        cls.load = rospy.ServiceProxy('load_state', StateFile)

    @classmethod
    def tearDownClass(cls):
        for folder in (cls.folder, cls.saving_folder):
            shutil.rmtree(folder, ignore_errors=True)

    def mapped_and_saved(self, name):
        """A new map, saved; gives path and map."""
        self.assertTrue(self.reset().success)
        self.robot.map_whole_room()
        reply = self.save(name)
        self.assertTrue(reply.success, reply.message)
        return reply.path, self.get_map().map

    def expect_at(self, message, expected):
        pose = message.pose.pose
        self.assertLess(math.hypot(pose.position.x - expected[0], pose.position.y - expected[1]),
                        0.05)
        self.assertLess(abs(angle_difference(yaw_of(pose.orientation), expected[2])), 0.02)

    def known(self, grid):
        """{(x, y): value} of the known cells, whatever the size of the grid."""
        data = numpy.array(grid.data, numpy.int8).reshape(grid.info.height, grid.info.width)
        origin = [round(v / grid.info.resolution)
                  for v in (grid.info.origin.position.x, grid.info.origin.position.y)]
        return {(x + origin[0], y + origin[1]): data[y, x] for y, x in numpy.argwhere(data >= 0)}

    def test_a_saved_map_is_taken_up_and_goes_on(self):
        path, saved = self.mapped_and_saved('room.state')
        self.assertEqual(path, os.path.join(self.folder, 'room.state'))
        self.assertEqual(os.listdir(self.folder).count('room.state'), 1)
        self.assertFalse([f for f in os.listdir(self.folder) if f.startswith('room.state.')])
        self.assertTrue(self.reset().success)
        reply = self.load('room.state')
        self.assertTrue(reply.success, reply.message)
        self.assertEqual(reply.path, path)
        self.assertEqual(self.known(self.get_map().map), self.known(saved))
        # Nobody has told where the robot is: it looks around.
        self.robot.begin((-1.0, 0.5, 2.0))
        self.expect_at(self.robot.find(), self.robot.expected())
        self.robot.drive(8)
        self.expect_at(self.robot.poses.at(self.robot.time - PERIOD), self.robot.expected())
        self.console.said('was found in the loaded map', node='/mapper')

    def test_a_robot_is_told_where_it_is(self):
        self.mapped_and_saved('told.state')
        self.assertTrue(self.load('told.state').success)
        told = PoseWithCovarianceStamped()
        told.header.frame_id = 'map'
        self.robot.begin((-2.0, -1.0, 0.5))
        expected = self.robot.expected()
        told.pose.pose.position.x, told.pose.pose.position.y = expected[:2]
        yaw_quaternion(told.pose.pose.orientation, expected[2])
        heard = len(self.console.messages)
        self.robot.initial_pose.publish(told)
        self.console.said('the pose was set by', after=heard)
        self.robot.drive(1)
        self.expect_at(self.robot.poses.at(self.robot.time - PERIOD), expected)

    def test_files_that_cannot_be_used_leave_everything_as_it_is(self):
        path, saved = self.mapped_and_saved('good.state')
        with open(path, 'rb') as file:
            content = file.read()
        cases = {'cut': (content[:-7], 'bytes too early'),
                 'damaged': (content[:300] + bytes([content[300] ^ 4]) + content[301:], 'damaged'),
                 'newer': (content[:8] + b'\x63' + content[9:], 'version is 99'),
                 'foreign': (b'P5\n1 1\n255\n.', 'no state of a map')}
        for name, (bad, reason) in cases.items():
            with self.subTest(name):
                with open(os.path.join(self.folder, name), 'wb') as file:
                    file.write(bad)
                reply = self.load(name)
                self.assertFalse(reply.success)
                self.assertIn(reason, reply.message)
                self.assertIn(os.path.join(self.folder, name), reply.message)
                self.assertIn('byte', reply.message)
        self.assertFalse(self.load('none').success)
        self.assertFalse(self.load('').success)
        self.assertFalse(self.save('../outside.state').success)
        self.assertFalse(os.path.exists(os.path.join(self.folder, '..', 'outside.state')))
        self.robot.drive(3)  # there are poses as before, in the same map
        self.expect_at(self.robot.poses.at(self.robot.time - PERIOD), self.robot.expected())
        now = self.known(self.get_map().map)
        self.assertLessEqual(set(self.known(saved)), set(now))

    def test_poses_go_on_while_a_file_is_read(self):
        self.assertTrue(self.reset().success)
        self.robot.begin(FIRST)
        self.robot.drive(1)
        pipe = os.path.join(self.folder, 'pipe')
        os.mkfifo(pipe)
        replies = []
        reader = threading.Thread(target=lambda: replies.append(self.load('pipe')))
        reader.start()
        with open(pipe, 'wb') as file:  # the mapper has opened it, and waits for what comes
            self.robot.drive(3)
            file.write(b'this is no map')
        reader.join()
        self.assertFalse(replies[0].success)
        self.assertIn('this is no state of a map', replies[0].message)

    def test_localization_leaves_the_map_alone_and_finds_a_robot_that_was_carried_away(self):
        path, saved = self.mapped_and_saved('localization.state')
        space = '/localization'
        process = subprocess.Popen(
            [program('mapper'), '__ns:=' + space, '_localization:=true', '_state_file:=' + path,
             '_map_folder:=' + self.folder], stdout=subprocess.DEVNULL)
        try:
            robot = Robot(space + '/')
            robot.wait_for_mapper()
            robot.begin((-1.0, -1.0, -0.7))
            self.expect_at(robot.find(), robot.expected())
            robot.drive(6)
            self.expect_at(robot.poses.at(robot.time - PERIOD), robot.expected())
            # Lifted and put down in a room that is not in the map; the matching does not notice.
            robot.scale = 3.0
            diagnostics = Recorder('/diagnostics', DiagnosticArray)

            def is_lost():
                robot.scan()
                return any('localization' in status.name and 'has not been found' in status.message
                           for message in diagnostics.messages for status in message.status)
            wait_for(is_lost, 'the diagnostics to say that the robot is lost')
            self.console.said('is not where it was thought to be', node=space + '/mapper')
            lost = robot.time
            for _ in range(30):
                robot.scan()
            # Carried back, to another place in the first room.
            robot.scale = 1.0
            robot.begin((-2.5, 0.5, 1.9))
            self.expect_at(robot.find(), robot.expected())
            self.assertFalse(robot.poses_between(lost, robot.start_time), 'in the other room')
            get_map = rospy.ServiceProxy(space + '/dynamic_map', GetMap)
            self.assertEqual(self.known(get_map().map), self.known(saved))
            again = rospy.ServiceProxy(space + '/save_state', StateFile)(path + '.after')
            self.assertTrue(again.success, again.message)
            with open(path, 'rb') as before, open(again.path, 'rb') as after:
                self.assertEqual(before.read(), after.read())
        finally:
            process.send_signal(signal.SIGINT)
            self.assertEqual(process.wait(30), 0)

    def test_a_full_disk_leaves_what_is_there(self):
        folder = os.path.join(self.folder, 'full')
        # Python ignores the signal of files that become too large, and hands that on.
        process = subprocess.Popen(
            [program('mapper'), '__ns:=/full', '_map_folder:=' + folder],
            stdout=subprocess.DEVNULL, restore_signals=False)
        try:
            robot = Robot('/full/')
            robot.wait_for_mapper()
            save_map = rospy.ServiceProxy('/full/save_map', SaveMap)
            save_state = rospy.ServiceProxy('/full/save_state', StateFile)

            def saved():
                """What the services answer, and what is in the folder then."""
                replies = save_map('room'), save_state('room.state')
                content = {}
                for name in os.listdir(folder):
                    with open(os.path.join(folder, name), 'rb') as file:
                        content[name] = file.read()
                return replies, content
            robot.begin(FIRST)
            robot.drive(3)
            replies, before = saved()
            self.assertEqual([reply.success for reply in replies], [True, True])
            self.assertEqual(set(before), {'room.pgm', 'room.yaml', 'room.state'})
            unlimited = resource.prlimit(process.pid, resource.RLIMIT_FSIZE)
            # The pixels do not fit; the few lines of the yaml would.
            resource.prlimit(process.pid, resource.RLIMIT_FSIZE, (1000, unlimited[1]))
            robot.drive(20)
            replies, content = saved()
            for reply, name in zip(replies, ('room.pgm', 'room.state')):
                self.assertFalse(reply.success)
                self.assertEqual(reply.message,
                                 f"can't write {os.path.join(folder, name)}: File too large")
            self.assertEqual(content, before)
            robot.drive(3)  # there are poses as before
            resource.prlimit(process.pid, resource.RLIMIT_FSIZE, unlimited)
            replies, after = saved()
            self.assertEqual([reply.success for reply in replies], [True, True])
            self.assertEqual(set(after), set(before))
            self.assertNotEqual(after['room.pgm'], before['room.pgm'])
            self.assertGreater(len(after['room.state']), len(before['room.state']))
        finally:
            process.send_signal(signal.SIGINT)
            self.assertEqual(process.wait(30), 0)

    def test_a_mapper_that_is_told_to_end_saves_first(self):
        for number, told in enumerate((signal.SIGTERM, signal.SIGINT)):
            space, name = f'/ending{number}', f'{told.name}.state'
            process = subprocess.Popen(
                [program('mapper'), '__ns:=' + space, '_map_folder:=' + self.folder,
                 '_state_file:=' + name, '_autosave_period:=3600'], stdout=subprocess.DEVNULL)
            try:
                robot = Robot(space + '/')
                robot.wait_for_mapper()
                robot.begin(FIRST)
                robot.drive(10)
                mapped = self.known(rospy.ServiceProxy(space + '/dynamic_map', GetMap)().map)
            finally:
                process.send_signal(told)
                self.assertEqual(process.wait(10.0), 0)
            reply = self.load(name)
            self.assertTrue(reply.success, reply.message)
            self.assertEqual(self.known(self.get_map().map), mapped)

    def test_a_mapper_that_dies_goes_on_with_what_it_saved(self):
        robot = Robot('/saving/')
        robot.wait_for_mapper()
        robot.map_whole_room()
        path = os.path.join(self.saving_folder, 'auto.state')
        load = rospy.ServiceProxy('load_state', StateFile)

        def all_saved():
            """What was saved last is what is there, seen through another mapper."""
            mine = rospy.ServiceProxy('/saving/dynamic_map', GetMap)().map
            return (os.path.exists(path) and load(path).success and
                    self.known(self.get_map().map) == self.known(mine))
        wait_for(all_saved, 'the map to be saved')
        pid = process_of('/saving/mapper')
        os.kill(pid, signal.SIGKILL)

        def is_back():
            try:
                return process_of('/saving/mapper') != pid
            except OSError:
                return False
        wait_for(is_back, 'the mapper to be started again')
        robot.wait_for_mapper()
        # The robot has gone on meanwhile, and so has the chain of its matches.
        robot.pose = compose(robot.pose, (0.3, 0.0, 0.4))
        self.expect_at(robot.find(), robot.expected())


if __name__ == '__main__':
    rostest.rosrun('scan_image_slam', 'mapper_state', MapperStateTest)
