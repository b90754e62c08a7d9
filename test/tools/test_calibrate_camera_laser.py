"""calibrate_camera_laser: what is true of the simulated robot is found again."""
import os
import struct
import unittest

from tools import ToolTest, copy_bag, key_values, read, run, simulate

# The mount of the simulated camera (laboratory): 0.12 0.0 0.55 m, pitch 0.07 rad, roll 0.015 rad.
WRONG = {
    "camera/from_tf": "false",
    "camera/x": 0.17,
    "camera/y": -0.05,
    "camera/z": 0.55,
    "camera/yaw_deg": -3.0,
    "camera/pitch_deg": 4.0107,
    "camera/roll_deg": 0.8594,
    "camera_time_offset": 0.03,
}


def wrong_mount():
    return [a for name, value in WRONG.items()
            for a in ("--set", "scan_image_fusion/%s=%s" % (name, value))]


def values(report):
    """Of each parameter of the report."""
    lines = [line for line in report.splitlines() if " value=" in line]
    return {line.split()[0]: float(key_values(line)["value"]) for line in lines}


class Calibrate(ToolTest):
    @classmethod
    def setUpClass(cls):
        cls.bag = cls.share_bag("--path", "fast", duration=16)

    def calibrate(self, bag, *arguments):
        return run("calibrate_camera_laser", "--bag", bag, *arguments)

    def expect_truth(self, found):
        self.assertAlmostEqual(found["camera/yaw_deg"], 0.0, delta=0.1)
        self.assertAlmostEqual(found["camera/x"], 0.12, delta=0.005)
        self.assertAlmostEqual(found["camera/y"], 0.0, delta=0.005)
        self.assertAlmostEqual(found["camera_time_offset"], 0.0, delta=0.002)
        self.assertAlmostEqual(found["camera/pitch_deg"], 4.01, delta=0.2)
        self.assertAlmostEqual(found["camera/roll_deg"], 0.86, delta=0.2)

    def test_wrong_mount_is_corrected_and_the_result_can_be_used(self):
        out, picture = self.path("mount.yaml"), self.path("picture.png")
        result = self.calibrate(self.bag, "--out", out, "--picture", picture, *wrong_mount(),
                                "--set", "mapper/resolution=0.1")
        self.expect(result, 0, "written=" + out)
        self.expect_truth(values(result.stdout))
        totals = key_values(result.stdout.splitlines()[0])
        self.assertGreater(float(totals["residual_before_px"]), 10.0)
        self.assertLess(float(totals["residual_after_px"]), 1.5)
        # Two pictures of 640 x 480, one above the other.
        self.assertEqual(struct.unpack(">II", read(picture, "rb")[16:24]), (640, 960))
        # What was configured is kept, and what is not configured is not written.
        self.assertIn("resolution: 0.1", read(out))
        self.assertNotIn("bounded_icp", read(out))
        check = self.calibrate(self.bag, "--config", out, "--check")
        self.expect(check, 0, "check=fits")
        self.expect_truth(values(check.stdout))
        slam = run("slam_offline", "--bag", self.bag, "--out", self.path("slam"), "--config", out)
        self.expect(slam, 0)

    def test_check_only_reports(self):
        before = set(os.listdir("."))
        result = self.calibrate(self.bag, "--check", *wrong_mount())
        self.expect(result, 0, "check=off", "camera/yaw_deg", "camera_time_offset")
        self.assertNotIn("written", result.stdout)
        self.assertEqual(set(os.listdir(".")), before)
        self.expect(self.calibrate(self.bag, "--check", "--out", self.path("x.yaml")), 1, "--out")

    def test_too_short_a_drive_is_refused(self):
        short = simulate(self.path("short.bag"), duration=1.5)  # the robot still waits
        out = self.path("short.yaml")
        self.expect(self.calibrate(short, "--out", out), 2, short, "too few pairs")
        self.assertFalse(os.path.exists(out))

    def test_without_images(self):
        blind = copy_bag(self.bag, self.path("blind.bag"),
                         lambda topic, _: not topic.startswith("/image"))
        self.expect(self.calibrate(blind), 2, blind, "no image", "--image-topic")

    def test_output_that_cannot_be_written(self):
        out = self.path("none", "mount.yaml")
        self.expect(self.calibrate(self.bag, "--out", out), 2, out)

    def test_wrong_configuration(self):
        self.expect(self.calibrate("none.bag", "--set", "mapper/none=1"), 1, "mapper/none")
        self.expect(self.calibrate(self.path("none.bag")), 2, "can't be opened")


if __name__ == "__main__":
    unittest.main()
