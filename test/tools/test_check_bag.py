"""check_bag: what a bag holds, what is odd in it, and command lines that work."""
import json
import os
import shlex
import subprocess
import unittest
import xml.etree.ElementTree

import rosbag
import rospy
import sensor_msgs.msg
import std_msgs.msg

from tools import FOLDER, ToolTest, copy_bag, read, read_tum, run, simulate

SOURCE = os.environ["SCAN_IMAGE_SLAM_SOURCE"]


def shift(stamp, seconds):
    return rospy.Time.from_sec(stamp.to_sec() + seconds)


class CheckBag(ToolTest):
    @classmethod
    def setUpClass(cls):
        cls.bag = cls.share_bag(duration=3)

    def shell(self, line):
        """As a user types it, with the programs in the path."""
        environment = dict(os.environ, PATH=FOLDER + os.pathsep + os.environ["PATH"],
                           ROS_MASTER_URI="http://localhost:1")
        return subprocess.run(line, shell=True, cwd=self.folder, env=environment,
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, text=True, timeout=300)

    def check(self, bag, *words, options=""):
        """Its report, and the arguments of bag.launch; all other lines are run."""
        result = self.shell("check_bag %s %s" % (shlex.quote(bag), options))
        self.expect(result, 0, *words)
        report, _, lines = result.stdout.partition("to map with it:\n")
        lines = [line.strip() for line in lines.splitlines()]
        self.assertTrue(lines[-2].startswith("slam_offline "), lines)
        self.assertTrue(lines[-1].startswith("roslaunch scan_image_slam bag.launch "), lines)
        for line in lines[:-1]:
            self.expect(self.shell(line), 0)
        self.offline = lines[-2]
        return report, self.launch_arguments(lines[-1])

    def launch_arguments(self, line):
        arguments = dict(word.split(":=") for word in shlex.split(line)[3:])
        tree = xml.etree.ElementTree.parse(os.path.join(SOURCE, "launch", "bag.launch"))
        known = {arg.get("name") for arg in tree.getroot().findall("arg")}
        self.assertLessEqual(set(arguments), known)
        return arguments

    def changed(self, change):
        """A copy of the bag after change(topic, message), which says False for what is left out."""
        return copy_bag(self.bag, self.path("changed.bag"),
                        lambda topic, message: change(topic, message) is not False)

    def used(self):
        """Images and scans that slam_offline has used, and whether encoders."""
        report = json.loads(read(self.path("results", "report.json")))
        return report["images"], report["scans"], bool(read_tum(self.path("results", "encoder.tum")))

    def test_a_good_bag(self):
        report, launch = self.check(self.bag, "1081 beams, -135 to 135 deg", "40 Hz", "640x480 px",
                                    "base_link -> camera_optical_frame")
        self.assertNotIn("error:", report)
        self.assertNotIn("warning:", report)
        self.assertEqual(self.offline, "slam_offline --bag %s --out results" % self.bag)
        self.assertEqual(launch, {"bag": self.bag})
        images, scans, encoders = self.used()
        self.assertGreater(images, 80)
        self.assertGreater(scans, 110)
        self.assertTrue(encoders)

    def test_called_by_its_path_it_tells_rosrun(self):
        self.assertIn("\n  rosrun scan_image_slam slam_offline --bag ",
                      run("check_bag", self.bag).stdout)

    def test_other_topics(self):
        bag = copy_bag(self.bag, self.path("other.bag"),
                       rename=lambda topic: topic if topic.startswith("/tf") else "/r" + topic)
        _, launch = self.check(bag)
        self.assertEqual(launch, {"bag": bag, "scan_topic": "/r/scan", "odom_topic": "/r/odom",
                                  "image_topic": "/r/image_raw",
                                  "camera_info_topic": "/r/camera_info"})
        self.assertGreater(self.used()[0], 80)

    def test_topics_that_were_recorded_without_their_slash(self):
        bag = copy_bag(self.bag, self.path("bare.bag"), rename=lambda topic: topic[1:])
        _, launch = self.check(bag)
        self.assertEqual(self.offline, "slam_offline --bag %s --out results" % bag)
        self.assertEqual(launch, {"bag": bag})
        self.assertGreater(self.used()[0], 80)
        self.assertTrue(self.used()[2])

    def test_raw_images(self):
        bag = simulate(self.path("raw.bag"), "--image-format", "mono8", duration=1)
        _, launch = self.check(bag, "mono8")
        self.assertEqual(launch["image_transport"], "raw")
        self.assertGreater(self.used()[0], 20)

    def test_a_path_with_a_space(self):
        os.mkdir(self.path("my bags"))
        bag = copy_bag(self.bag, self.path("my bags", "a.bag"))
        _, launch = self.check(bag)
        self.assertEqual(launch["bag"], bag)

    def expect_no_camera(self, bag, *words):
        report, launch = self.check(bag, "error: the images are left out", *words)
        self.assertIn("--no-images", self.offline)
        self.assertEqual(launch["use_camera"], "false")
        self.assertEqual(self.used()[0], 0)
        return report

    def test_camera_without_a_transform(self):
        def change(topic, message):
            if topic == "/tf_static":
                message.transforms = [t for t in message.transforms if t.child_frame_id == "laser"]

        self.expect_no_camera(self.changed(change), "base_link -> camera_optical_frame",
                              "calibrate_camera_laser")

    def test_camera_without_a_calibration(self):
        self.expect_no_camera(self.changed(lambda topic, _: topic != "/camera_info"),
                              "there is no calibration")

        def change(topic, message):
            if topic == "/camera_info":
                message.K = [0] * 9

        self.expect_no_camera(self.changed(change), "the camera is not calibrated")

    def test_calibration_for_another_size(self):
        def change(topic, message):
            if topic == "/camera_info":
                message.width, message.height = 1280, 960

        self.expect_no_camera(self.changed(change), "1280x960 px", "640x480 px")

    def test_images_that_cannot_be_read(self):
        def change(topic, message):
            if topic == "/image_raw/compressed":
                message.data = b"no picture"

        self.expect_no_camera(self.changed(change), "error: /image_raw/compressed: of the images")

    def test_images_from_another_clock(self):
        def change(topic, message):
            if topic == "/image_raw/compressed":
                message.header.stamp = shift(message.header.stamp, seconds)

        seconds = 1.5
        report, _ = self.check(self.changed(change))
        self.assertIn("error: /image_raw/compressed: ", report)
        self.assertIn("other clocks", report)
        seconds = 1000.0
        self.expect_no_camera(self.changed(change), "no time in common")

    def test_no_transforms_at_all(self):
        bag = self.changed(lambda topic, _: topic not in ("/tf", "/tf_static"))
        report, launch = self.check(bag, "warning: laser: no transform base_link -> laser",
                                    "note: there is no transform odom -> base_link")
        self.assertIn("robot.yaml", report)
        self.assertIn("--config robot.yaml", self.offline)
        self.assertEqual(launch["config"], "$PWD/robot.yaml")
        self.assertTrue(os.path.exists(self.path("robot.yaml")))
        self.assertTrue(self.used()[2])

    def test_scans_alone(self):
        _, launch = self.check(self.changed(lambda topic, _: topic == "/scan"),
                               "warning: there are no encoders", "note: there are no images")
        self.assertEqual(launch["base_frame"], "laser")
        self.assertEqual(self.used(), (0, 120, False))

    def test_encoders_from_transforms_of_another_name(self):
        def change(topic, message):
            for transform in getattr(message, "transforms", []):
                if transform.header.frame_id == "odom":
                    transform.header.frame_id = "wheels"
            return topic != "/odom"

        _, launch = self.check(self.changed(change), "transform wheels -> base_link")
        self.assertIn("--set scan_image_fusion/odom_frame=wheels", self.offline)
        self.assertEqual(launch["odom_frame"], "wheels")
        self.assertTrue(self.used()[2])

    def test_encoders_without_stamps(self):
        def change(topic, message):
            if topic == "/odom":
                message.header.stamp = rospy.Time(0)

        _, launch = self.check(self.changed(change), "taken from the transform odom -> base_link",
                               "error: /odom: 100 % of the messages have a stamp of zero")
        self.assertIn("--set scan_image_fusion/odom_source=tf", self.offline)
        self.assertEqual(launch["odom_source"], "tf")
        self.assertTrue(self.used()[2])

    def test_encoders_that_are_reset(self):
        zero = []

        def change(topic, message):
            if topic == "/odom":
                position = message.pose.pose.position
                if message.header.stamp.to_sec() - begin > 2:
                    zero.append(position.x)
                    position.x -= 5.0

        with rosbag.Bag(self.bag) as bag:
            begin = bag.get_start_time()
        self.check(self.changed(change), "/odom: the encoders jump once, first 2")
        self.assertTrue(zero)

    def test_another_base_frame(self):
        def change(_, message):
            for transform in getattr(message, "transforms", []):
                for owner, field in ((transform.header, "frame_id"),
                                     (transform, "child_frame_id")):
                    if getattr(owner, field) == "base_link":
                        setattr(owner, field, "/base_footprint")
            if hasattr(message, "child_frame_id"):
                message.child_frame_id = "base_footprint"

        _, launch = self.check(self.changed(change))
        self.assertIn("--base-frame base_footprint", self.offline)
        self.assertEqual(launch["base_frame"], "base_footprint")

    def test_a_mount_that_two_programs_publish(self):
        """The value that comes more often is used, though another comes first."""
        with rosbag.Bag(self.bag) as bag:
            _, static, _ = next(bag.read_messages(["/tf_static"]))

        def change(topic, message):
            if topic == "/tf":
                message.transforms += [t for t in static.transforms if t.child_frame_id == "laser"]
            if topic == "/tf_static":
                for transform in message.transforms:
                    transform.transform.translation.x += 0.3

        report, _ = self.check(self.changed(change), "transform base_link -> laser takes 2 values")
        laser = next(t for t in static.transforms if t.child_frame_id == "laser")
        self.assertIn("laser        %g m ahead" % laser.transform.translation.x, report)

    def test_gaps_and_jumps_back(self):
        def change(topic, message):
            since = message.header.stamp.to_sec() - begin if topic == "/scan" else 0.0
            if 1.0 < since < 1.6:
                return False
            if since > 2.5:
                message.header.stamp = shift(message.header.stamp, -1.0)
            return True

        with rosbag.Bag(self.bag) as bag:
            begin = bag.get_start_time()
        report, _ = self.check(self.changed(change))
        self.assertIn("/scan: 1 gap, the longest 6", report)
        self.assertIn("error: /scan: stamps jump back, by up to 975 ms", report)

    def test_the_most_serious_comes_first(self):
        bag = self.changed(lambda topic, _: topic not in ("/odom", "/tf", "/camera_info"))
        report, _ = self.check(bag)
        kinds = [line.split(":")[0].strip() for line in report.splitlines()
                 if line.strip().startswith(("error:", "warning:", "note:"))]
        self.assertLessEqual({"error", "warning"}, set(kinds))
        self.assertEqual(kinds, sorted(kinds, key=["error", "warning", "note"].index))

    def test_a_chosen_topic(self):
        with rosbag.Bag(self.bag) as bag, rosbag.Bag(self.path("two.bag"), "w") as copy:
            for topic, message, time in bag.read_messages():
                copy.write(topic, message, time)
                if topic == "/scan":
                    copy.write("/rear/scan", message, time)
        _, launch = self.check(self.path("two.bag"), "/scan is used, not /rear/scan")
        self.assertNotIn("scan_topic", launch)
        _, launch = self.check(self.path("two.bag"), options="--scan-topic /rear/scan")
        self.assertEqual(launch["scan_topic"], "/rear/scan")
        self.expect(run("check_bag", self.bag, "--scan-topic", "/none"), 2, "/none")

    def test_raw_images_whose_rows_are_too_short(self):
        """They are neither read beyond their end nor looked at for the pattern of a mosaic."""
        with rosbag.Bag(self.bag) as bag, rosbag.Bag(self.path("short.bag"), "w") as copy:
            for topic, message, time in bag.read_messages():
                if message._type == "sensor_msgs/CompressedImage":
                    topic = "/image_raw"
                    message = sensor_msgs.msg.Image(header=message.header, width=640, height=480,
                                                    encoding="mono8", step=1, data=bytes(640 * 480))
                copy.write(topic, message, time)
        self.expect(run("check_bag", self.path("short.bag")), 0, "/image_raw",
                    "shorter than its size and encoding 'mono8' say")

    def test_longer_than_a_duration_of_ros(self):
        """68 years, as where the clock was set while it was recorded."""
        bag = copy_bag(self.bag, self.path("long.bag"))
        with rosbag.Bag(bag, "a") as long:
            long.write("/note", std_msgs.msg.String(), rospy.Time(4000000000))
        self.expect(run("check_bag", bag), 0, "long.bag: ", "/scan")

    def test_recordings(self):
        folder = os.environ.get("SCAN_IMAGE_SLAM_DATA", "")
        bags = [os.path.join(folder, name) for name in sorted(os.listdir(folder))
                if name.endswith(".bag")] if os.path.isdir(folder) else []
        if not bags:
            self.skipTest("there are no recordings")
        for bag in bags:
            with self.subTest(bag=bag):
                self.check(bag)

    def test_what_cannot_be_mapped_with(self):
        self.expect(run("check_bag", self.changed(lambda topic, _: topic != "/scan")), 2,
                    "there are no scans")

        def without_stamps(topic, message):
            if topic == "/scan":
                message.header.stamp = rospy.Time(0)

        self.expect(run("check_bag", self.changed(without_stamps)), 2, "none of the scans can be",
                    "/scan: 100 % of the messages have a stamp of zero")

        def tilt(topic, message):
            if topic == "/tf_static":
                for transform in message.transforms:
                    transform.transform.rotation.x = 0.38268343  # 45 degrees
                    transform.transform.rotation.w = 0.92387953

        self.expect(run("check_bag", self.changed(tilt)), 2, "base_link -> laser")
        self.expect(run("check_bag", self.path("none.bag")), 2, "can't be opened")
        self.expect(run("check_bag", self.write("no.bag", "no bag")), 2, "not a readable bag")


if __name__ == "__main__":
    unittest.main()
