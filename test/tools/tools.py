"""What the tests of the command-line programs share: running them, and making small bags."""
import os
import re
import shutil
import subprocess
import tempfile
import unittest

import rosbag

FOLDER = os.environ["SCAN_IMAGE_SLAM_TOOLS"]  # where the programs are


def run(tool, *arguments, timeout=300):
    """Runs a program with neither a ROS master nor a terminal."""
    environment = dict(os.environ, ROS_MASTER_URI="http://localhost:1")
    return subprocess.run(
        [os.path.join(FOLDER, tool)] + [str(a) for a in arguments],
        env=environment,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        universal_newlines=True,
        timeout=timeout,
    )


def simulate(path, *arguments, duration=1.5):
    result = run("simulate", "--world", "laboratory", "--out", path, "--duration", duration, *arguments)
    if result.returncode != 0:
        raise RuntimeError(result.stderr)
    return path


def copy_bag(source, target, keep=lambda topic, message: True, rename=lambda topic: topic):
    """Copies the messages that `keep` wants."""
    with rosbag.Bag(source) as bag, rosbag.Bag(target, "w") as copy:
        for topic, message, time in bag.read_messages():
            if keep(topic, message):
                copy.write(rename(topic), message, time)
    return target


def stamps(bag, topic):
    """Stamps of the headers, in seconds with nine digits, as text."""
    with rosbag.Bag(bag) as opened:
        headers = [message.header for _, message, _ in opened.read_messages(topics=[topic])]
    return ["%d.%09d" % (h.stamp.secs, h.stamp.nsecs) for h in headers]


def read(path, mode="r"):
    with open(path, mode) as file:
        return file.read()


def read_tum(path):
    """Rows of eight numbers, as text."""
    rows = [line.split() for line in read(path).splitlines() if not line.startswith("#")]
    for row in rows:
        assert len(row) == 8, row
        for number in row:
            float(number)
    return rows


def key_values(line):
    return dict(re.findall(r"(\S+)=(\S+)", line))


class ToolTest(unittest.TestCase):
    """With a folder of its own in self.folder."""

    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)

    @classmethod
    def share_bag(cls, *arguments, duration):
        """A simulated bag that all tests of the class use."""
        folder = tempfile.mkdtemp()
        cls.addClassCleanup(shutil.rmtree, folder)
        return simulate(os.path.join(folder, "run.bag"), *arguments, duration=duration)

    def path(self, *parts):
        return os.path.join(self.folder, *parts)

    def write(self, name, text, mode="w"):
        with open(self.path(name), mode) as file:
            file.write(text)
        return self.path(name)

    def expect(self, result, code, *words):
        """Checks the exit code and that the messages hold all of `words`."""
        told = result.stdout + result.stderr
        self.assertEqual(result.returncode, code, told)
        for word in words:
            self.assertIn(word, told)
        if code != 0:
            self.assertEqual(result.stdout, "", "errors belong on stderr")
