"""evaluate_trajectory and evaluate_relations: one line of key=value pairs, figures by hand."""
import os
import unittest

from tools import ToolTest, key_values, run

STRAIGHT = "".join("%d.0 %d 0 0 0 0 0 1\n" % (i, i) for i in range(11))  # 1 m/s along x


class EvaluateTrajectory(ToolTest):
    def setUp(self):
        super().setUp()
        self.reference = self.write("reference.tum", "# a comment\n" + STRAIGHT)

    def evaluate(self, estimate, *options):
        path = self.write("estimate.tum", estimate)
        return run("evaluate_trajectory", self.reference, path, *options)

    def test_perfect(self):
        result = self.evaluate(STRAIGHT)
        self.expect(result, 0)
        self.assertEqual(result.stdout.count("\n"), 1)
        values = key_values(result.stdout)
        self.assertEqual(float(values["ate_rmse_m"]), 0.0)
        self.assertAlmostEqual(float(values["path_m"]), 10.0)

    def test_error_that_grows(self):
        # Ten per cent too far: errors 0.0, 0.1 ... 1.0, mean of squares 3.85 / 11.
        too_far = "".join("%d.0 %.1f 0 0 0 0 0 1\n" % (i, 1.1 * i) for i in range(11))
        values = key_values(self.evaluate(too_far).stdout)
        self.assertAlmostEqual(float(values["ate_rmse_m"]), (3.85 / 11) ** 0.5, places=4)

    def test_offset_counts_only_without_alignment(self):
        aside = "".join("%d.0 %d 2 0 0 0 0 1\n" % (i, i) for i in range(11))
        self.assertEqual(float(key_values(self.evaluate(aside).stdout)["ate_rmse_m"]), 0.0)
        values = key_values(self.evaluate(aside, "--align", "none").stdout)
        self.assertAlmostEqual(float(values["ate_rmse_m"]), 2.0)

    def test_poses_without_reference_are_told(self):
        result = self.evaluate(STRAIGHT + "50.0 0 0 0 0 0 0 1\n")
        self.expect(result, 0, "1 of 12")

    def test_plot(self):
        picture = self.path("errors.png")
        result = self.evaluate(STRAIGHT, "--plot", picture)
        self.expect(result, 0)
        self.assertEqual(result.stdout.count("\n"), 1)
        with open(picture, "rb") as file:
            self.assertEqual(file.read(8), b"\x89PNG\r\n\x1a\n")

    def test_plot_that_cannot_be_written(self):
        picture = self.path("none", "errors.png")
        result = self.evaluate(STRAIGHT, "--plot", picture)
        self.assertEqual(result.returncode, 2)
        self.assertIn(picture, result.stderr)

    def test_unusable_files(self):
        self.expect(self.evaluate(""), 2, "estimate.tum")
        self.expect(self.evaluate("0.0 1 2\n"), 2, "estimate.tum", "1")
        self.expect(self.evaluate("0 0 0 0 0 0 0 1\n1 nan 0 0 0 0 0 1\n"), 2, "estimate.tum", "2")
        missing = self.path("missing.tum")
        self.expect(run("evaluate_trajectory", self.reference, missing), 2, missing)

    def test_wrong_usage(self):
        self.expect(self.evaluate(STRAIGHT, "--align", "worst"), 1, "--align")
        self.expect(self.evaluate(STRAIGHT, "--max-gap", "-1"), 1, "max_gap")


class EvaluateRelations(ToolTest):
    def evaluate(self, relations, estimate=STRAIGHT, *options):
        return run("evaluate_relations", self.write("true.relations", relations),
                   self.write("estimate.tum", estimate), *options)

    def test_mean_of_two(self):
        # The estimate moved 2 m and 3 m; the truth says 2 m and 3.5 m: errors 0 and 0.5.
        result = self.evaluate("0 2 2 0 0 0 0 0\n2 5 3.5 0 0 0 0 0\n")
        self.expect(result, 0)
        self.assertEqual(result.stdout.count("\n"), 1)
        values = key_values(result.stdout)
        self.assertEqual(values["relations"], "2")
        self.assertAlmostEqual(float(values["trans_mean_m"]), 0.25, places=6)

    def test_relations_outside_the_estimate_are_told(self):
        self.expect(self.evaluate("0 2 2 0 0 0 0 0\n90 95 0 0 0 0 0 0\n"), 0, "1 of 2")

    def test_unusable_files(self):
        self.expect(self.evaluate(""), 2, "true.relations")
        self.expect(self.evaluate("0 2 2 0 0\n"), 2, "true.relations", "1")
        self.expect(self.evaluate("90 95 0 0 0 0 0 0\n"), 2)
        missing = self.path("missing.relations")
        self.expect(run("evaluate_relations", missing, os.devnull), 2, missing)

    def test_wrong_usage(self):
        wrong = self.evaluate("0 2 2 0 0 0 0 0\n", STRAIGHT, "--tolerance", "-1")
        self.expect(wrong, 1, "tolerance")


if __name__ == "__main__":
    unittest.main()
