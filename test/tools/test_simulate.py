"""simulate: a bag of the robot's sensors and the truth beside it."""
import os
import unittest

import rosbag

from tools import ToolTest, read, read_tum, run, simulate, stamps


def counts(path):
    with rosbag.Bag(path) as bag:
        return {t: i.message_count for t, i in bag.get_type_and_topic_info().topics.items()}


class Simulate(ToolTest):
    def test_rates_and_truth(self):
        bag = simulate(self.path("run.bag"), duration=1.5)
        topics = counts(bag)
        # 40 Hz laser, 30 Hz camera and encoders; the first and last may fall to either side.
        self.assertAlmostEqual(topics["/scan"], 60, delta=2)
        self.assertAlmostEqual(topics["/image_raw/compressed"], 45, delta=2)
        self.assertEqual(topics["/camera_info"], topics["/image_raw/compressed"])
        self.assertAlmostEqual(topics["/odom"], 45, delta=3)
        self.assertEqual(topics["/tf_static"], 1)
        self.assertNotIn("/ground_truth", topics)
        truth = read_tum(self.path("run.gt.tum"))
        # The stamps of the scans are the truth's up to the laser's clock, a millisecond.
        scans = stamps(bag, "/scan")
        self.assertEqual(len(truth), len(scans))
        for row, stamp in zip(truth, scans):
            self.assertAlmostEqual(float(row[0]), float(stamp), delta=1e-3)

    def test_same_seed_gives_the_same_bytes(self):
        for name in ("a", "b"):
            simulate(self.path(name + ".bag"), "--seed", 7, duration=0.5)
        simulate(self.path("c.bag"), "--seed", 8, duration=0.5)
        a, b, c = (read(self.path(n + ".bag"), "rb") for n in "abc")
        self.assertEqual(a, b)
        self.assertNotEqual(a, c)

    def test_without_images_the_scans_are_the_same(self):
        simulate(self.path("with.bag"), duration=0.5)
        simulate(self.path("without.bag"), "--no-images", duration=0.5)
        self.assertNotIn("/camera_info", counts(self.path("without.bag")))
        scans = []
        for name in ("with.bag", "without.bag"):
            with rosbag.Bag(self.path(name)) as bag:
                raw = bag.read_messages(topics=["/scan"], raw=True)
                scans.append([message[1] for _, message, _ in raw])
        self.assertEqual(len(scans[0]), len(scans[1]))
        self.assertTrue(scans[0] == scans[1])  # too long to print

    def test_image_formats(self):
        for encoding in ("mono8", "bgr8", "bayer_rggb8"):
            path = simulate(self.path("x.bag"), "--image-format", encoding, duration=0.3)
            with rosbag.Bag(path) as bag:
                image = next(bag.read_messages(topics=["/image_raw"])).message
            self.assertEqual(image.encoding, encoding)
            self.assertEqual(len(image.data), image.step * image.height)

    def test_unknown_world_lists_those_there_are(self):
        result = run("simulate", "--world", "atlantis", "--out", self.path("x.bag"))
        self.expect(result, 2, "atlantis", "corridor_dark, ", "laboratory, ", "path of a file")
        result = run("simulate", "--world", "/none/x.yaml", "--out", self.path("x.bag"))
        self.expect(result, 2, "/none/x.yaml")
        self.assertFalse(os.path.exists(self.path("x.bag")))

    def test_mistyped_key_of_a_world_names_file_and_line(self):
        world = self.write("w.yaml", "include: corridor.yaml\nwals: []\n")
        self.expect(run("simulate", "--world", world, "--out", self.path("x.bag")), 2, "w.yaml")

    def test_unknown_path_lists_those_there_are(self):
        out = ["--world", "laboratory", "--out", self.path("x.bag")]
        self.expect(run("simulate", *out, "--path", "nowhere"), 1, "nowhere", "fast")

    def test_values_out_of_range_are_wrong_usage(self):
        out = ["--world", "laboratory", "--out", self.path("x.bag"), "--no-images"]
        for wrong in (["--duration", "-1"], ["--duration", "soon"], ["--image-format", "tiff"],
                      ["--seed", "-1"], ["--jpeg-quality", "0"]):
            with self.subTest(wrong=wrong):
                self.expect(run("simulate", *out, *wrong), 1, wrong[0])

    def test_output_that_cannot_be_written(self):
        nowhere = self.path("none", "x.bag")
        result = run("simulate", "--world", "laboratory", "--out", nowhere, "--duration", 0.3)
        self.expect(result, 2, nowhere)


if __name__ == "__main__":
    unittest.main()
