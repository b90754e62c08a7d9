"""slam_offline: wrong configuration (exit code 1) and unusable input (2), each named."""
import os
import unittest

import rosbag
from tools import ToolTest, copy_bag, read, run


class Configuration(ToolTest):
    """Told before the bag is looked at."""

    def slam(self, *arguments):
        return run("slam_offline", "--bag", "none.bag", "--out", self.path("out"), *arguments)

    def config(self, text):
        return self.slam("--config", self.write("my.yaml", text))

    def test_unknown_parameter(self):
        self.expect(self.slam("--set", "mapper/no_such_thing=1"), 1, "mapper/no_such_thing")
        self.expect(self.config("mapper:\n  no_such_thing: 1\n"), 1, "my.yaml",
                    "mapper/no_such_thing")

    def test_mistyped_parameter_gets_a_suggestion(self):
        self.expect(self.slam("--set", "mapper/resoluton=0.1"), 1, "mapper/resoluton",
                    "mean resolution?")
        self.expect(self.config("mapper:\n  resoluton: 0.1\n"), 1, "mean resolution?")

    def test_out_of_range(self):
        self.expect(self.slam("--set", "mapper/resolution=-1"), 1, "mapper/resolution", "-1")
        self.expect(self.config("mapper:\n  resolution: -1\n"), 1, "mapper/resolution")
        self.expect(self.slam("--set", "mapper/resolution=nan"), 1, "mapper/resolution")

    def test_wrong_type(self):
        self.expect(self.slam("--set", "mapper/resolution=fine"), 1, "mapper/resolution", "fine")
        self.expect(self.config("mapper:\n  resolution: [1]\n"), 1, "my.yaml:2", "resolution")

    def test_unknown_node(self):
        self.expect(self.slam("--set", "maper/resolution=0.1"), 1, "maper")

    def test_setting_without_a_value(self):
        for setting in ("mapper/resolution", "resolution=1", "="):
            self.expect(self.slam("--set", setting), 1, setting, "NODE/PARAMETER=VALUE")

    def test_configuration_that_cannot_be_read(self):
        self.expect(self.slam("--config", self.path("no.yaml")), 1, "no.yaml")
        self.expect(self.config("mapper: [\n"), 1, "my.yaml")

    def test_threads_out_of_range(self):
        self.expect(self.slam("--threads", "0"), 1, "--threads")
        self.expect(self.slam("--threads", "many"), 1, "--threads")


class Input(ToolTest):
    @classmethod
    def setUpClass(cls):
        cls.bag = cls.share_bag(duration=0.6)

    def slam(self, bag, *arguments, out="out"):
        return run("slam_offline", "--bag", bag, "--out", self.path(out), *arguments)

    def refused(self, bag, *words, arguments=()):
        self.expect(self.slam(bag, *arguments), 2, bag, *words)
        self.assertFalse(os.path.exists(self.path("out")), "nothing is written for nothing")

    def without(self, *topics):
        return copy_bag(self.bag, self.path("part.bag"), lambda topic, _: topic not in topics)

    def test_missing_bag(self):
        self.refused(self.path("none.bag"), "can't be opened")

    def test_folder(self):
        os.mkdir(self.path("folder.bag"))
        self.refused(self.path("folder.bag"))

    def test_empty_file(self):
        self.refused(self.write("empty.bag", ""), "empty")

    def test_no_bag(self):
        self.refused(self.write("text.bag", "this is no bag\n" * 100), "1500 bytes")

    def test_truncated_bag_names_the_byte(self):
        whole = read(self.bag, "rb")
        for size in (len(whole) // 2, len(whole) - 1, 5000, 20):
            with self.subTest(size=size):
                self.refused(self.write("cut.bag", whole[:size], "wb"), str(size))

    def test_bag_that_was_not_closed(self):
        # While it is recorded, a bag has no index: its place in the header is 0.
        whole = read(self.bag, "rb")
        at = whole.index(b"index_pos=") + len(b"index_pos=")
        self.refused(self.write("open.bag", whole[:at] + bytes(8) + whole[at + 8:], "wb"),
                     "no index", "reindex")

    def test_damaged_in_the_middle(self):
        whole = bytearray(read(self.bag, "rb"))
        middle = len(whole) // 3
        whole[middle:middle + 300000] = bytes(300000)
        self.expect(self.slam(self.write("bad.bag", bytes(whole), "wb")), 2, "bad.bag", "damaged")

    def test_without_scans(self):
        self.refused(self.without("/scan"), "/scan", "LaserScan")

    def test_topic_that_is_not_there(self):
        self.refused(self.bag, "/laser", "/scan", arguments=["--scan-topic", "/laser"])
        self.refused(self.bag, "/wheel", arguments=["--odom-topic", "/wheel"])
        self.refused(self.bag, "/eye", arguments=["--image-topic", "/eye"])

    def test_without_transforms(self):
        bag = self.without("/tf", "/tf_static")
        self.refused(bag, "no transform laser -> camera_optical_frame", "--no-images")
        self.expect(self.slam(bag, "--no-images"), 0, "taken to be at the base")

    def test_without_the_laser_transform(self):
        def keep(topic, message):
            if topic == "/tf_static":
                message.transforms = [t for t in message.transforms if t.child_frame_id != "laser"]
            return True

        bag = copy_bag(self.bag, self.path("deaf.bag"), keep)
        self.refused(bag, "no transform base_link -> laser", "--base-frame")

    def test_images_of_two_cameras(self):
        bag = copy_bag(self.bag, self.path("eyes.bag"),
                       lambda topic, _: topic != "/image_raw/compressed")
        with rosbag.Bag(bag, "a") as eyes, rosbag.Bag(self.bag) as one:
            for _, message, time in one.read_messages(topics=["/image_raw/compressed"]):
                eyes.write("/left", message, time)
                eyes.write("/right", message, time)
        self.expect(self.slam(bag), 0, "images: none", "--image-topic", "/left", "/right")

    def test_a_run_that_fails_leaves_the_results_of_the_last(self):
        self.expect(self.slam(self.bag), 0)
        report = read(self.path("out", "report.json"))

        def blind(topic, message):
            if topic == "/scan":
                message.ranges = []
            return True

        bag = copy_bag(self.bag, self.path("blind.bag"), blind)
        self.expect(self.slam(bag), 2, "no scan could be used")
        self.assertEqual(read(self.path("out", "report.json")), report)

    def test_without_the_camera_transform(self):
        def keep(topic, message):
            if topic == "/tf_static":
                message.transforms = [t for t in message.transforms if t.child_frame_id == "laser"]
            return True

        bag = copy_bag(self.bag, self.path("blind.bag"), keep)
        self.refused(bag, "camera_optical_frame", "--no-images")
        self.expect(self.slam(bag, "--no-images"), 0)

    def test_without_camera_info(self):
        bag = self.without("/camera_info")
        self.refused(bag, "/camera_info", "--no-images")
        self.expect(self.slam(bag, "--no-images"), 0)

    def test_unknown_base_frame(self):
        self.refused(self.bag, "base_lnk", arguments=["--base-frame", "base_lnk"])

    def test_output_that_cannot_be_written(self):
        blocked = self.path(self.write("file", ""), "out")
        self.expect(run("slam_offline", "--bag", self.bag, "--out", blocked), 2, blocked)
        os.makedirs(self.path("taken", "report.json"))
        self.expect(self.slam(self.bag, out="taken"), 2, self.path("taken"))


if __name__ == "__main__":
    unittest.main()
