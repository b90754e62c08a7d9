"""scripts/recorded_data.py: a table of what slam_offline gives on recordings."""
import json
import os
import subprocess
import unittest

from tools import FOLDER, ToolTest, key_values, read, read_tum, run, simulate

SCRIPT = os.path.join(os.environ["SCAN_IMAGE_SLAM_SOURCE"], "scripts", "recorded_data.py")


class RecordedData(ToolTest):
    def table(self, *arguments, code=0):
        result = subprocess.run([SCRIPT, self.path("data"), FOLDER, *arguments],
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.assertEqual(result.returncode, code, result.stderr)
        rows = [[cell.strip() for cell in line.strip("|").split("|")]
                for line in result.stdout.splitlines()]
        if code != 0:
            return result.stderr
        self.assertEqual(len({len(cells) for cells in rows}), 1, "as many cells in every row")
        return {cells[0]: dict(zip(rows[0], cells)) for cells in rows[2:]}

    def recording(self, name, *arguments):
        os.makedirs(self.path("data"), exist_ok=True)
        return simulate(self.path("data", name + ".bag"), *arguments, duration=2)

    def test_with_truth_the_error_is_that_of_evaluate_trajectory(self):
        self.recording("run")
        cells = self.table("--out", self.path("out"))["`run`"]
        self.assertEqual(int(cells["scans"]), len(read_tum(self.path("out", "run", "online.tum"))))
        self.assertGreater(int(cells["images"]), 30)
        report = json.loads(read(self.path("out", "run.no_images", "report.json")))
        self.assertEqual(report["images"], 0)
        expected = []
        for what, path in (("", "run/online"), ("without images ", "run.no_images/online"),
                           ("encoders ", "run/encoder")):
            result = run("evaluate_trajectory", self.path("data", "run.gt.tum"),
                         self.path("out", path + ".tum"))
            ate = float(key_values(result.stdout)["ate_rmse_m"])
            expected.append("%s%.1f mm" % (what, 1000 * ate))
        self.assertEqual(cells["error"], "ATE: " + ", ".join(expected))

    def test_with_relations_and_without_anything(self):
        self.recording("none", "--no-images")
        os.remove(self.path("data", "none.gt.tum"))
        self.recording("some", "--no-images")
        truth = read_tum(self.path("data", "some.gt.tum"))
        os.remove(self.path("data", "some.gt.tum"))
        # The robot stands still for the first second; this relation claims that it drove 3 m.
        self.write("data/some.relations", "%s %s 3 0 0 0 0 0\n" % (truth[20][0], truth[40][0]))
        rows = self.table()
        self.assertEqual(rows["`none`"]["error"], "no truth")
        errors = rows["`some`"]["error"]
        self.assertTrue(errors.startswith("relations: "), errors)
        for part in errors[len("relations: "):].split(", "):
            self.assertRegex(part, r"(2\.99\d|3\.00\d) m \(median (2\.99\d|3\.00\d) m\)$")
        self.assertEqual(errors.count("median"), 3)

    def test_only_some(self):
        self.recording("a", "--no-images")
        self.recording("b", "--no-images")
        self.assertEqual(list(self.table("--only", "b")), ["`b`"])
        self.assertIn("no c.bag", self.table("--only", "c", code=1))

    def test_without_recordings(self):
        self.assertIn("no folder", self.table(code=1))
        os.makedirs(self.path("data"))
        self.assertIn("no bag", self.table(code=1))

    def test_what_cannot_be_read_is_named(self):
        bag = self.recording("cut", "--no-images")
        self.write("data/cut.bag", read(bag, "rb")[:1000], "wb")
        told = self.table(code=2)
        self.assertIn("slam_offline", told)
        self.assertIn("cut.bag", told)


if __name__ == "__main__":
    unittest.main()
