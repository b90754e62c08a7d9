#!/usr/bin/env python3
"""Parameters are changed while the three nodes run, by the clients of dynamic_reconfigure."""

import re
import unittest

import numpy
import rospy
import rostest
from dynamic_reconfigure import DynamicReconfigureCallbackException
from dynamic_reconfigure.client import Client
from dynamic_reconfigure.msg import Config, DoubleParameter
from dynamic_reconfigure.srv import Reconfigure
from geometry_msgs.msg import PoseWithCovarianceStamped
from live_support import (START, Console, Recorder, make_odometry, program, publisher, room_scan,
                          run, static_transforms, transform, wait_for, wait_subscribed)
from nav_msgs.msg import OccupancyGrid, Odometry
from scan_image_slam.msg import IcpModel, ScanMatch
from sensor_msgs.msg import LaserScan

NODES = ('scan_image_fusion', 'bounded_icp', 'mapper')
PERIOD = 0.1  # [s]
STEP = 0.01  # [m]


def told_live():
    """{node: {name: (type, default)}} of the live parameters, by the reference."""
    nodes, node = {}, None
    for line in run(program('list_parameters'), '--markdown').splitlines():
        if line.startswith('## '):
            node = nodes.setdefault(line[3:], {})
        cells = [cell.strip() for cell in line.strip('|').split('|')]
        if len(cells) == 7 and cells[5] == 'live' and cells[0].startswith('`'):
            node[cells[0].strip('`')] = (cells[1], cells[2])
    return nodes


class LiveParametersTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('live_parameters_test')
        cls.static = static_transforms(transform('base_link', 'laser', z=0.3))
        cls.scan = publisher('scan', LaserScan)
        cls.odom = publisher('odom', Odometry)
        cls.console = Console()
        cls.models = Recorder('icp_model', IcpModel).wait_connected()
        cls.matches = Recorder('scan_match', ScanMatch).wait_connected()
        cls.poses = Recorder('pose', PoseWithCovarianceStamped).wait_connected()
        cls.maps = Recorder('map', OccupancyGrid).wait_connected()
        wait_subscribed(cls.scan, cls.odom)
        cls.clients = {node: Client(node, timeout=60) for node in NODES}
        cls.time, cls.way = START, 0.0
        # It was an hour: without the change there would be no map.
        cls.clients['mapper'].update_configuration({'map_update_interval': 0.2})
        # Topics and transforms come on ways of their own.
        wait_for(lambda: cls.publish() or rospy.sleep(0.1) or cls.poses.messages, 'a pose')

    @classmethod
    def publish(cls):
        cls.time += PERIOD
        cls.way += STEP
        for ahead in (0.0, 0.05):
            cls.odom.publish(make_odometry(cls.time + ahead, cls.way + ahead * STEP / PERIOD))
        cls.scan.publish(room_scan(cls.time, (cls.way, 0.0, 0.0)))

    def drive(self):
        """One scan: its model, match and pose."""
        self.publish()
        pose = self.poses.at(self.time).pose.pose.position
        return self.models.at(self.time), self.matches.at(self.time), pose

    def change(self, node, **changes):
        """Until the test has ended. Names have two underscores for a slash."""
        changes = {name.replace('__', '/'): value for name, value in changes.items()}
        client = self.clients[node]
        before = {name: client.get_configuration(60)[name] for name in changes}
        self.addCleanup(client.update_configuration, before)
        return client.update_configuration(changes)

    def config(self, node, name):
        return self.clients[node].get_configuration(60)[name]

    def wait_config(self, node, name, value):
        wait_for(lambda: self.config(node, name) == value, f'{name} = {value}')

    def expect_refused(self, node, changes, *words):
        heard = len(self.console.messages)
        before = {name: self.config(node, name) for name in changes}
        with self.assertRaises(DynamicReconfigureCallbackException):
            self.clients[node].update_configuration(dict(changes))
        self.console.said('nothing was changed', *words, node='/' + node, after=heard)
        fresh = Client(node, timeout=60).get_configuration(60)
        self.assertEqual({name: fresh[name] for name in changes}, before)

    def test_the_fusion_takes_another_range(self):
        model, _, _ = self.drive()
        ranges = numpy.array(model.ranges)
        self.assertTrue(numpy.any(ranges > 2.5) and numpy.any(ranges < 2.5))
        answer = self.change('scan_image_fusion', max_range=2.5)
        self.assertEqual(answer['max_range'], 2.5)
        model, _, _ = self.drive()
        ranges = numpy.array(model.ranges)
        self.assertTrue(numpy.any(numpy.isnan(ranges)))
        self.assertLessEqual(numpy.nanmax(ranges), 2.5)
        self.assertEqual(rospy.get_param('/scan_image_fusion/max_range'), 2.5)

    def test_the_matching_takes_another_window(self):
        _, match, _ = self.drive()
        self.assertLess(match.window_distance, 0.4)
        self.change('bounded_icp', window__min_distance=0.4)
        _, match, _ = self.drive()
        self.assertGreaterEqual(match.window_distance, 0.4)

    def test_the_map_takes_another_probability(self):
        def last_map(hit):
            """The last map in which cells that one scan has hit have this value."""
            return next((m for m in reversed(self.maps.messages) if hit in m.data), None)
        self.drive()
        wait_for(lambda: last_map(75), 'cells that one scan has hit')
        self.change('mapper', update_factor_occupied=0.9)
        after = wait_for(lambda: last_map(90), 'cells of another value')
        before = last_map(75)
        self.assertEqual(after.info.resolution, before.info.resolution)
        self.assertEqual(after.info.width, before.info.width)
        new, old = numpy.array(after.data), numpy.array(before.data)
        numpy.testing.assert_array_equal(new[old == 75], 90)
        numpy.testing.assert_array_equal(new == -1, old == -1)

    def test_pose_map_and_chain_of_matches_stay(self):
        _, before, pose_before = self.drive()
        self.change('scan_image_fusion', min_range=0.2, edge_threshold=20.0)
        self.change('bounded_icp', noise__distance_per_distance=0.2, refinement__gate=0.2)
        self.change('mapper', loop__min_agreement=0.9, tf_delay=0.1, transform_publish_period=0.1)
        _, after, pose_after = self.drive()
        self.assertEqual(after.start_stamp, before.start_stamp)
        self.assertEqual(after.status, ScanMatch.STATUS_MATCHED)
        self.assertAlmostEqual(pose_after.x - pose_before.x, STEP, delta=0.005)
        self.assertAlmostEqual(pose_after.y - pose_before.y, 0.0, delta=0.005)

    def test_what_is_out_of_range_is_refused(self):
        self.expect_refused('scan_image_fusion', {'max_range': -1.0},
                            '/scan_image_fusion/max_range: -1.0 is out of range')
        self.expect_refused('bounded_icp', {'window/min_distance': 1e6},
                            '/bounded_icp/window/min_distance: 1000000.0 is out of range')
        self.expect_refused('mapper', {'update_factor_free': 0.6},
                            '/mapper/update_factor_free: 0.6 is out of range')

    def test_all_values_of_a_request_are_taken_or_none(self):
        self.expect_refused('scan_image_fusion', {'roi_above': 1.0, 'max_range': -1.0},
                            'max_range: -1.0 is out of range')
        self.expect_refused('scan_image_fusion', {'roi_above': 1.0, 'min_range': 200.0},
                            '/scan_image_fusion/max_range must be greater than min_range')

    def test_what_is_not_live_is_refused(self):
        heard = len(self.console.messages)
        service = rospy.ServiceProxy('/mapper/set_parameters', Reconfigure)
        with self.assertRaises(rospy.ServiceException):
            service(Config(doubles=[DoubleParameter('resolution', 0.1)]))
        self.console.said("/mapper/resolution: can't be changed while the node runs", after=heard)

    def test_what_is_offered_is_what_the_reference_tells(self):
        told = told_live()
        for node in NODES:
            self.assertGreater(len(told[node]), 10)
            offered = {}
            for one in self.clients[node].get_parameter_descriptions(60):
                self.assertLessEqual(one['min'], one['default'])
                self.assertGreaterEqual(one['max'], one['default'])
                offered[one['name']] = (one['type'], one['default'])
            self.assertEqual(set(offered), set(told[node]))
            for name, (kind, default) in told[node].items():
                self.assertEqual(offered[name][0], kind)
                self.assertAlmostEqual(offered[name][1], float(default), 9)

    def test_dynparam(self):
        def dynparam(*words):
            return run('rosrun', 'dynamic_reconfigure', 'dynparam', *words)
        self.addCleanup(self.clients['bounded_icp'].update_configuration,
                        {'window/min_distance': self.config('bounded_icp', 'window/min_distance')})
        self.assertEqual(set(re.findall(r'/(\w+)', dynparam('list'))), set(NODES))
        dynparam('set', '/bounded_icp', 'window/min_distance', '0.3')
        self.assertIn("'window/min_distance': 0.3", dynparam('get', '/bounded_icp'))
        _, match, _ = self.drive()
        self.assertGreaterEqual(match.window_distance, 0.3)


if __name__ == '__main__':
    rostest.rosrun('scan_image_slam', 'live_parameters', LiveParametersTest)
