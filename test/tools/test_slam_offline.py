"""slam_offline: what it writes for usable bags."""
import hashlib
import json
import os
import unittest

import cv2
import yaml

from tools import ToolTest, copy_bag, read, read_tum, run, simulate, stamps

FILES = [
    "encoder.tum",
    "map.pgm",
    "map.png",
    "map.yaml",
    "online.tum",
    "report.json",
    "trajectory.tum",
]
KEYS = {"scans", "images", "real_time_factor", "cpu_ms_per_scan", "peak_memory_mb", "stages",
        "modes", "window_edge_hits", "loop_closures", "dropped"}


def read_pgm(path):
    """Width, height and pixels of a binary grey picture."""
    words = read(path, "rb").split(None, 4)
    while words[1].startswith(b"#"):  # a comment line
        head, _, rest = read(path, "rb").partition(b"\n")
        words = (head + b"\n" + rest.partition(b"\n")[2]).split(None, 4)
    assert words[0] == b"P5" and words[3] == b"255"
    width, height = int(words[1]), int(words[2])
    pixels = read(path, "rb")[-width * height:]
    return width, height, pixels


class SlamOffline(ToolTest):
    def setUp(self):
        super().setUp()
        self.bag = simulate(self.path("run.bag"))

    def slam(self, bag, *arguments, out="out"):
        result = run("slam_offline", "--bag", bag, "--out", self.path(out), *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result

    def report(self, out="out"):
        return json.loads(read(self.path(out, "report.json")))

    def test_writes_all_files_and_keys(self):
        self.slam(self.bag)
        self.assertEqual(sorted(os.listdir(self.path("out"))), FILES)
        report = self.report()
        self.assertLessEqual(KEYS, set(report))
        for stage in ("fusion", "match", "map", "loop"):
            times = report["stages"][stage]
            ordered = [times[k] for k in ("min_ms", "median_ms", "p99_ms", "max_ms")]
            self.assertEqual(ordered, sorted(ordered))
        for mode in ("full", "no_camera", "no_encoders", "laser_only", "coasting"):
            self.assertIn(mode + "_s", report["modes"])
        self.assertGreater(report["peak_memory_mb"], 1.0)

    def test_one_pose_for_each_scan(self):
        self.slam(self.bag)
        scans = stamps(self.bag, "/scan")
        report = self.report()
        self.assertEqual(report["scans"] + report["dropped"], len(scans))
        self.assertEqual(report["dropped"], 0)
        for name in ("online.tum", "trajectory.tum"):
            self.assertEqual([row[0] for row in read_tum(self.path("out", name))], scans)
        encoder = [row[0] for row in read_tum(self.path("out", "encoder.tum"))]
        # The first scans may come before the encoders have said anything.
        self.assertEqual(encoder, scans[-len(encoder):])
        self.assertGreater(len(encoder), len(scans) - 5)

    def test_poses_are_right(self):
        self.slam(self.bag)
        for pose in read_tum(self.path("out", "online.tum")):
            norm = sum(float(q) ** 2 for q in pose[4:])
            self.assertAlmostEqual(norm, 1.0, places=6)
        # Half a second of driving at the end: as far as the truth says, within 2 cm.
        way = [self.distance("out/online.tum"), self.distance("run.gt.tum")]
        self.assertGreater(way[1], 0.05)
        self.assertAlmostEqual(way[0], way[1], delta=0.02)

    def distance(self, name):
        rows = read_tum(self.path(*name.split("/")))
        return sum((float(rows[-1][i]) - float(rows[0][i])) ** 2 for i in (1, 2)) ** 0.5

    def test_map_loads_as_map_server_wants_it(self):
        # Far enough for walls and floor to be seen often enough to be believed.
        bag = simulate(self.path("long.bag"), "--no-images", duration=6)
        self.slam(bag)
        info = yaml.safe_load(read(self.path("out", "map.yaml")))
        self.assertEqual(info["image"], "map.pgm")
        self.assertEqual(info["negate"], 0)
        self.assertEqual(len(info["origin"]), 3)
        self.assertLess(info["free_thresh"], info["occupied_thresh"])
        width, height, pixels = read_pgm(self.path("out", "map.pgm"))
        # The laboratory is 11.4 m x 10 m; walls are seen from inside, so the map holds it.
        self.assertGreater(width * info["resolution"], 11.0)
        self.assertGreater(height * info["resolution"], 9.5)
        self.assertEqual(set(pixels) - {0, 205, 254}, set())
        free = pixels.count(254) * info["resolution"] ** 2
        self.assertGreater(free, 20.0)
        self.assertLess(free, 114.0)
        self.assertGreater(pixels.count(0), 100)

    def test_same_result_again_and_with_other_threads(self):
        for out, threads in (("a", 1), ("b", 1), ("c", 3)):
            self.slam(self.bag, "--threads", threads, out=out)
        for name in FILES:
            if name == "report.json":  # holds times
                continue
            digests = {hashlib.sha256(read(self.path(o, name), "rb")).digest() for o in "abc"}
            self.assertEqual(len(digests), 1, name)
        reports = [self.report(o) for o in "abc"]
        for key in ("scans", "images", "modes", "window_edge_hits", "dropped"):
            self.assertEqual(reports[0][key], reports[1][key])
            self.assertEqual(reports[0][key], reports[2][key])

    def test_compressed_and_raw_images_are_used(self):
        self.slam(self.bag)
        self.assertGreater(self.report()["images"], 30)
        raw = simulate(self.path("raw.bag"), "--image-format", "mono8")
        self.slam(raw, out="raw")
        self.assertEqual(self.report("raw")["images"], self.report()["images"])

    def test_pictures_of_the_fusion(self):
        self.slam(self.bag, "--fusion-images", 10)
        pictures = sorted(f for f in os.listdir(self.path("out")) if f not in FILES)
        # 30 images a second for 1.5 s; the first of ten, whatever the last ones are.
        self.assertEqual(pictures[:3], ["fusion_%06d.png" % n for n in (1, 11, 21)])
        self.assertLessEqual(len(pictures), 5)
        pixels = cv2.imread(self.path("out", pictures[0]))
        self.assertEqual(pixels.shape[1], 640)
        self.assertGreater(pixels.shape[0], 480)  # with the strength by bearing below
        # Beams and edges are drawn in colours; the picture itself is grey.
        spread = pixels.max(axis=2).astype(int) - pixels.min(axis=2)
        self.assertGreater((spread > 100).sum(), 500)
        self.slam(self.bag, "--fusion-images", 10, "--no-images", out="without")
        self.assertEqual(sorted(os.listdir(self.path("without"))), FILES)

    def test_film_of_the_fusion(self):
        film = self.path("fusion.avi")
        self.slam(self.bag, "--video", film)
        video = cv2.VideoCapture(film)
        self.assertEqual(video.get(cv2.CAP_PROP_FPS), 30)
        frames = 0
        while True:
            read, frame = video.read()
            if not read:
                break
            frames += 1
            self.assertEqual(frame.shape[1], 640)
        # Each image that was fused; the first and the last may find no scan.
        self.assertLessEqual(abs(frames - self.report()["images"]), 2)
        self.assertGreater(frames, 30)
        result = run("slam_offline", "--bag", self.bag, "--out", self.path("out"), "--video",
                     self.path("nowhere", "fusion.avi"))
        self.assertEqual(result.returncode, 2)
        self.assertIn("nowhere/fusion.avi", result.stderr)

    def test_no_images(self):
        self.slam(self.bag, "--no-images")
        self.assertEqual(self.report()["images"], 0)
        self.assertEqual(self.report()["modes"]["full_s"], 0.0)
        self.assertGreater(self.report()["modes"]["no_camera_s"], 1.0)

    def test_scan_alone_means_constant_velocity(self):
        bag = copy_bag(self.bag, self.path("scan.bag"), lambda topic, _: topic == "/scan")
        self.slam(bag)
        self.assertEqual(self.report()["scans"], len(stamps(bag, "/scan")))
        self.assertGreater(self.report()["modes"]["laser_only_s"], 1.0)
        self.assertEqual(read_tum(self.path("out", "encoder.tum")), [])

    def test_scan_and_odometry(self):
        wanted = ("/scan", "/odom", "/tf", "/tf_static")
        bag = copy_bag(self.bag, self.path("odom.bag"), lambda topic, _: topic in wanted)
        self.slam(bag)
        self.slam(self.bag, "--no-images", out="without")
        for name in ("online.tum", "map.pgm"):
            self.assertEqual(read(self.path("out", name), "rb"),
                             read(self.path("without", name), "rb"))

    def test_scan_and_odometry_alone(self):
        bag = copy_bag(self.bag, self.path("bare.bag"), lambda topic, _: topic in ("/scan", "/odom"))
        self.slam(bag)
        self.assertGreater(self.report()["modes"]["no_camera_s"], 1.0)
        self.assertEqual(len(read_tum(self.path("out", "encoder.tum"))), self.report()["scans"])

    def test_odometry_from_transforms(self):
        wanted = ("/scan", "/tf", "/tf_static")
        bag = copy_bag(self.bag, self.path("tf.bag"), lambda topic, _: topic in wanted)
        self.slam(bag)
        self.assertGreater(self.report()["modes"]["no_camera_s"], 1.0)

    def test_other_topics(self):
        def rename(topic):
            return topic if topic.startswith("/tf") else "/robot" + topic

        bag = copy_bag(self.bag, self.path("other.bag"), rename=rename)
        self.slam(bag, "--scan-topic", "/robot/scan", "--odom-topic", "robot/odom",
                  "--image-topic", "/robot/image_raw", "--camera-info-topic", "/robot/camera_info")
        self.slam(self.bag, out="usual")
        self.assertEqual(read(self.path("out", "online.tum")),
                         read(self.path("usual", "online.tum")))

    def test_topics_that_were_recorded_without_their_slash(self):
        bare = copy_bag(self.bag, self.path("bare.bag"), rename=lambda topic: topic[1:])
        self.slam(bare, "--scan-topic", "scan")
        self.slam(self.bag, out="usual")
        self.assertGreater(self.report()["images"], 30)
        for name in ("online.tum", "encoder.tum"):
            self.assertEqual(read(self.path("out", name)), read(self.path("usual", name)))

    def test_paper_configuration(self):
        self.slam(self.bag, "--config", "paper")
        self.slam(self.bag, out="default")
        self.assertNotEqual(read(self.path("out", "online.tum")),
                            read(self.path("default", "online.tum")))

    def test_settings_by_file_and_by_option_mean_the_same(self):
        config = self.write("my.yaml", "mapper:\n  resolution: 0.1\n")
        self.slam(self.bag, "--config", config)
        self.slam(self.bag, "--set", "mapper/resolution=0.1", out="set")
        self.assertEqual(read(self.path("out", "map.pgm"), "rb"),
                         read(self.path("set", "map.pgm"), "rb"))
        self.assertEqual(yaml.safe_load(read(self.path("out", "map.yaml")))["resolution"], 0.1)


if __name__ == "__main__":
    unittest.main()
