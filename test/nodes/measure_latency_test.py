#!/usr/bin/env python3
"""measure_latency, with this test in the place of the nodes."""

import itertools
import json
import math
import os
import re
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

import rospy
import rostest
from geometry_msgs.msg import PoseWithCovarianceStamped
from live_support import program, publisher, room_scan, stamp_of, wait_for
from scan_image_slam.msg import IcpModel
from sensor_msgs.msg import LaserScan

NAME = '/measure_latency_test'


def resident_mb():
    with open('/proc/self/status') as file:
        line = next(line for line in file if line.startswith('VmRSS'))
    return float(line.split()[1]) * 1024 / 1e6


class MeasureLatencyTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('measure_latency_test')
        cls.scans = publisher('front/scan', LaserScan)
        cls.poses = publisher('pose', PoseWithCovarianceStamped)
        cls.models = publisher('icp_model', IcpModel)  # a second topic of the same process

    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        self.file = os.path.join(self.folder, 'latency.json')
        self.errors = os.path.join(self.folder, 'errors')

    def start(self, *options):
        return self.run_in_group(program('measure_latency'), '--json', self.file, *options)

    def run_in_group(self, *command):
        """Starts a program in a process group of its own, as a terminal does."""
        with open(self.errors, 'w') as errors:
            process = subprocess.Popen(command, text=True, stdout=subprocess.PIPE, stderr=errors,
                                       start_new_session=True)
        self.addCleanup(process.kill)
        return process

    def said(self):
        """On stderr."""
        with open(self.errors) as file:
            return file.read()

    def scan(self, number):
        self.scans.publish(room_scan(1000.0 + number))

    def pose(self, number, x=0.0):
        message = PoseWithCovarianceStamped()
        message.pose.pose.position.x = x
        message.pose.pose.orientation.w = 1.0
        message.header.stamp = stamp_of(1000.0 + number)
        self.poses.publish(message)

    def stop(self, process):
        os.killpg(process.pid, signal.SIGINT)  # as Ctrl-C does
        output, _ = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 0, self.said())
        return output, self.report()

    def begin(self, process):
        """Scans and poses until the tool has begun to count; gives the number of the last."""
        numbers = itertools.count()

        def begun():
            number = next(numbers)
            self.scan(number)
            self.pose(number)
            return 'measuring' in self.said()
        wait_for(begun, 'the tool to begin')
        return next(numbers)

    def report(self):
        with open(self.file) as file:
            return json.load(file)

    def test_late_and_missing_poses(self):
        process = self.start('--scan-topic', 'front/scan', '--period', '0.2')
        last = self.begin(process)
        wait_for(lambda: os.path.exists(self.file), 'the first period')
        before = self.report()['scans']
        for number in range(last, last + 5):
            self.scan(number)
        begin = time.monotonic()
        wait_for(lambda: time.monotonic() > begin + 0.3, 'that time')  # so late, at least
        self.pose(last + 2)
        self.pose(last + 4, x=math.nan)
        wait_for(lambda: self.report()['dropped'] == 3, 'three dropped scans')
        output, report = self.stop(process)
        self.assertGreaterEqual(report['scans'], before + 5)
        self.assertEqual(report['dropped'], 3)
        self.assertEqual(sum(row['scans'] for row in report['histogram']), report['scans'] - 3)
        self.assertEqual(sum(row['scans'] for row in report['histogram']
                             if (row['up_to_ms'] or 1e9) > 200), 2)
        self.assertGreaterEqual(report['latency_ms']['max'], 300)
        self.assertEqual(report['poses_without_scan'], 0)
        self.assertEqual(report['poses_not_finite'], 1)
        self.assertIn('3 of them without a pose', output)

        self.assertEqual(list(report['nodes']), [NAME])
        load = report['nodes'][NAME]
        self.assertAlmostEqual(load['memory_mb'], resident_mb(), delta=0.2 * resident_mb())
        self.assertGreaterEqual(load['peak_memory_mb'], load['memory_mb'])
        self.assertAlmostEqual(load['threads'], len(os.listdir('/proc/self/task')), delta=5)
        self.assertAlmostEqual(load['open_files'], len(os.listdir('/proc/self/fd')), delta=5)
        self.assertAlmostEqual(load['cpu_ms_per_scan'] * report['scans'] / 1e3,
                               load['cpu_percent'] / 100 * report['seconds'], 6)
        periods = report['periods']
        self.assertAlmostEqual(sum(p['seconds'] for p in periods), report['seconds'], 6)
        self.assertEqual(sum(p['scans'] for p in periods), report['scans'])
        self.assertEqual(sum(p['dropped'] for p in periods), 3)

    def test_report_of_a_long_run(self):
        truth = os.path.join(self.folder, 'truth.tum')
        with open(truth, 'w') as file:  # the poses that are published stand still
            file.writelines(f'{1000 + 0.5 * i} {0.25 * i} 0 0 0 0 0 1\n' for i in range(1000))
        process = self.run_in_group(
            program('soak.py'), '--out', self.folder, '--period', '0.2', '--scan-topic',
            'front/scan', '--programs', os.path.dirname(program('measure_latency')), '--truth', truth)
        wait_for(lambda: self.poses.get_num_connections() > 1, 'who records the poses')
        last = self.begin(process)
        self.pose(last, x=math.nan)
        for number in range(last, last + 20):
            self.scan(number)
            self.pose(number)
        wait_for(lambda: os.path.exists(self.file) and len(self.report()['periods']) > 4, 'periods')
        report = self.stop(process)[1]
        with open(os.path.join(self.folder, 'report.md')) as file:
            page = file.read()
        self.assertIn(f"{report['scans']} scans, {report['dropped']} of them without", page)
        self.assertIn(f'| {NAME} | ', page)
        self.assertIn('1 poses that are not finite', page)
        self.assertIn('at worst', page, self.said())
        worst = float(re.search(r'at worst ([0-9.]+) m', page).group(1))
        self.assertGreater(worst, 1.0)
        for picture in ('latency.png', 'load.png', 'error.png'):
            self.assertIn(f']({picture})', page)
            self.assertGreater(os.path.getsize(os.path.join(self.folder, picture)), 5000)

    def test_long_run_by_one_command(self):
        process = self.run_in_group(
            program('soak.py'), '--simulate', 'laboratory', '--duration', '5', '--period', '1',
            '--out', self.folder, '--programs', os.path.dirname(program('measure_latency')))
        output, _ = process.communicate(timeout=120)
        self.assertEqual(process.returncode, 0, self.said())
        self.assertIn(os.path.join(self.folder, 'report.md'), output)
        with open(os.path.join(self.folder, 'report.md')) as file:
            page = file.read()
        for node in ('/scan_image_fusion', '/bounded_icp', '/mapper'):
            self.assertIn(f'| {node} | ', page)
        self.assertIn('0 poses that are not finite', page)
        worst = float(re.search(r'at worst ([0-9.]+) m', page).group(1))
        self.assertTrue(0.0 < worst < 0.05, worst)

    def test_processor_time_of_the_nodes(self):
        process = self.start('--scan-topic', 'front/scan')
        before = time.process_time()
        self.begin(process)
        begin = time.process_time()
        while time.process_time() < begin + 2.0:
            pass
        report = self.stop(process)[1]
        used = time.process_time() - before
        cpu = report['nodes'][NAME]['cpu_percent'] / 100 * report['seconds']
        self.assertGreater(cpu, 1.9)
        self.assertLess(cpu, used + 0.1)  # not what was used before

    def expect_error(self, process, *words):
        output, _ = process.communicate(timeout=60)
        self.assertEqual((process.returncode, output), (2, ''))
        self.assertFalse(os.path.exists(self.file))
        for word in words:
            self.assertIn(word, self.said())

    def test_no_scan(self):
        self.expect_error(self.start('--wait', '1'), 'no scan came on /scan within 1 s',
                          '--scan-topic')

    def test_no_pose(self):
        process = self.start('--wait', '2', '--scan-topic', 'front/scan', '--pose-topic', 'where')
        numbers = itertools.count()
        wait_for(lambda: self.scan(next(numbers)) or process.poll() is not None, 'its end')
        self.expect_error(process, 'scans come on /front/scan', '/where', '--pose-topic')

    def test_no_master(self):
        done = subprocess.run([program('measure_latency')], text=True, stderr=subprocess.PIPE,
                              env=dict(os.environ, ROS_MASTER_URI='http://localhost:1'))
        self.assertEqual(done.returncode, 2)
        self.assertIn('no master answers at http://localhost:1', done.stderr)


if __name__ == '__main__':
    rostest.rosrun('scan_image_slam', 'measure_latency_test', MeasureLatencyTest)
