"""reproduce_table1 and coreslam_offline on runs of a second or two."""
import csv
import glob
import os
import unittest

from tools import ToolTest, key_values, read, read_tum, run, simulate

COLUMNS = ["map", "seed", "sensors", "method", "config", "error_px", "error_m", "yaw_deg", "fps"]


class ReproduceTable1(ToolTest):
    def reproduce(self, name, *arguments):
        folder = self.path(name)
        short = ("--maps", 1, "--duration", 1.5)
        self.expect(run("reproduce_table1", "--out", folder, *short, *arguments), 0)
        with open(os.path.join(folder, "table1.csv"), newline="") as file:
            return list(csv.DictReader(file))

    def test_writes_a_row_for_each_method_and_run(self):
        rows = self.reproduce("one", "--seeds", 2)
        self.assertEqual(list(rows[0]), COLUMNS)
        runs = {(r["seed"], r["sensors"], r["method"], r["config"]) for r in rows}
        methods = [("coreslam", "original"), ("proposed", "default"), ("proposed", "paper")]
        expected = {
            (seed, sensors) + method
            for seed in "12"
            for sensors in ("ideal", "realistic")
            for method in methods
        }
        self.assertEqual(runs, expected)
        self.assertEqual(len(rows), len(expected))
        for row in rows:
            self.assertEqual(row["map"], "laboratory")
            self.assertAlmostEqual(float(row["error_px"]) * 0.05, float(row["error_m"]), places=6)
            self.assertGreater(float(row["fps"]), 0.0)
        report = read(self.path("one", "table1.md"))
        for words in ("Sensors: ideal", "Sensors: realistic", "CoreSLAM", "5 cm", "laboratory"):
            self.assertIn(words, report)
        pictures = glob.glob(self.path("one", "figure6_laboratory_*.png"))
        self.assertEqual(len(pictures), 2)

    def test_does_not_depend_on_the_number_of_threads(self):
        def without_time(rows):
            return [{k: v for k, v in row.items() if k != "fps"} for row in rows]

        one = self.reproduce("one", "--seeds", 2, "--threads", 1)
        three = self.reproduce("three", "--seeds", 2, "--threads", 3)
        self.assertEqual(without_time(one), without_time(three))

    def test_goes_on_where_it_was_cancelled(self):
        all_rows = self.reproduce("one", "--seeds", 2)
        kept = self.path("one", "runs", "laboratory_ideal_1.csv")
        os.remove(self.path("one", "runs", "laboratory_realistic_2.csv"))
        with open(kept) as file:
            text = file.read()
        with open(kept, "w") as file:
            file.write(text.replace(",coreslam,original,", ",coreslam,kept,"))
        again = self.reproduce("one", "--seeds", 2)
        self.assertEqual(len(again), len(all_rows))
        self.assertEqual([r["config"] for r in again].count("kept"), 1)

    def test_takes_no_run_of_other_settings(self):
        self.reproduce("one", "--seeds", 1)
        setting = "bounded_icp/refinement/max_iterations=0"
        with_setting = self.reproduce("one", "--seeds", 1, "--set", setting)
        fresh = self.reproduce("two", "--seeds", 1, "--set", setting)
        self.assertEqual(
            [row["error_m"] for row in with_setting], [row["error_m"] for row in fresh]
        )

    def test_wrong_usage(self):
        out = self.path("out")
        self.expect(run("reproduce_table1"), 1, "--out")
        self.expect(run("reproduce_table1", "--out", out, "--worlds", "nowhere"), 1, "nowhere")
        self.expect(run("reproduce_table1", "--out", out, "--set", "no/such=1"), 1, "no")
        self.expect(run("reproduce_table1", "--out", out, "--sensors", "magic"), 1, "magic")


class CoreSlamOffline(ToolTest):
    def test_writes_a_pose_for_each_scan(self):
        bag = simulate(self.path("run.bag"), "--no-images")
        result = run("coreslam_offline", "--bag", bag, "--out", self.path("out"))
        self.expect(result, 0)
        poses = read_tum(self.path("out", "trajectory.tum"))
        self.assertEqual(int(key_values(result.stdout)["scans"]), len(poses))
        self.assertGreater(len(poses), 50)

    def test_unusable_input(self):
        missing = self.path("missing.bag")
        self.expect(
            run("coreslam_offline", "--bag", missing, "--out", self.path("out")), 2, missing
        )
        self.expect(run("coreslam_offline", "--bag", missing), 1, "--out")


if __name__ == "__main__":
    unittest.main()
