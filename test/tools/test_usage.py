"""Help and wrong usage, which are the same for all programs."""
import unittest

from tools import ToolTest, run

OPTIONS = {
    "slam_offline": [
        "--bag",
        "--out",
        "--config",
        "--set",
        "--no-images",
        "--fusion-images",
        "--video",
        "--threads",
        "--scan-topic",
        "--image-topic",
        "--camera-info-topic",
        "--odom-topic",
        "--base-frame",
    ],
    "calibrate_camera_laser": [
        "--bag",
        "--out",
        "--picture",
        "--check",
        "--config",
        "--set",
        "--scan-topic",
        "--image-topic",
        "--camera-info-topic",
        "--odom-topic",
        "--base-frame",
    ],
    "check_bag": ["bag", "--scan-topic", "--image-topic", "--camera-info-topic", "--odom-topic"],
    "simulate": ["--world", "--out", "--seed", "--duration", "--no-noise", "--no-images"],
    "evaluate_trajectory": ["--plot", "--align"],
    "evaluate_relations": ["--tolerance"],
    "evaluate_map": ["world", "truth", "map", "--pose", "--tolerance", "--plot"],
    "list_parameters": ["--help"],
    "measure_latency": ["--duration", "--json", "--period", "--wait", "--scan-topic", "--pose-topic"],
}


class Usage(ToolTest):
    def test_help_names_every_option(self):
        for tool, options in OPTIONS.items():
            with self.subTest(tool=tool):
                self.expect(run(tool, "--help"), 0, *options)

    def test_unknown_option_is_wrong_usage(self):
        for tool in OPTIONS:
            with self.subTest(tool=tool):
                self.expect(run(tool, "--no-such-option"), 1)

    def test_missing_arguments_are_wrong_usage(self):
        for tool in OPTIONS:
            if tool in ("list_parameters", "measure_latency"):
                continue
            with self.subTest(tool=tool):
                self.expect(run(tool), 1, "required")


if __name__ == "__main__":
    unittest.main()
