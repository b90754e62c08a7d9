"""slam_offline: maps that are saved, continued and localised in."""
import json
import math
import os
import unittest

from tools import ToolTest, read, read_tum, run, simulate


class SlamOfflineState(ToolTest):
    def setUp(self):
        super().setUp()
        self.bag = simulate(self.path("run.bag"), "--no-images", duration=8)
        self.state = self.path("map.state")
        self.slam("mapped", "--save-state", self.state)

    def slam(self, out, *arguments, code=0):
        result = run("slam_offline", "--bag", self.bag, "--out", self.path(out), *arguments)
        self.assertEqual(result.returncode, code, result.stderr)
        return result

    def report(self, out):
        return json.loads(read(self.path(out, "report.json")))

    def map(self, out):
        return read(self.path(out, "map.pgm"), "rb")

    def poses(self, out):
        return {row[0]: [float(value) for value in row[1:3]]
                for row in read_tum(self.path(out, "online.tum"))}

    def expect_same_path(self, out):
        """The same bag again: where the robot is found, it is where it was."""
        before, after = self.poses("mapped"), self.poses(out)
        self.assertGreater(len(after), 0.9 * len(before))
        for stamp, (x, y) in after.items():
            self.assertLess(math.hypot(x - before[stamp][0], y - before[stamp][1]), 0.05)

    def test_localization_leaves_the_map_as_it_is(self):
        self.slam("localized", "--state", self.state, "--localization",
                  "--save-state", self.path("after.state"))
        self.assertEqual(read(self.path("after.state"), "rb"), read(self.state, "rb"))
        self.assertEqual(self.map("localized"), self.map("mapped"))
        self.expect_same_path("localized")
        report = self.report("localized")
        self.assertLess(len(self.poses("localized")), report["scans"], "at first it is lost")
        self.assertLess(report["lost_s"], 1.0)
        self.assertEqual(self.report("mapped")["lost_s"], 0.0)
        self.assertEqual(report["scans"], self.report("mapped")["scans"])

    def test_goes_on_with_a_map(self):
        self.slam("continued", "--state", self.state, "--save-state", self.path("after.state"))
        self.expect_same_path("continued")
        self.assertGreater(os.path.getsize(self.path("after.state")),
                           1.5 * os.path.getsize(self.state))
        # A robot that was found can be found again in what it has added.
        self.slam("again", "--state", self.path("after.state"), "--localization")
        self.expect_same_path("again")

    def test_what_is_no_state_is_refused(self):
        content = read(self.state, "rb")
        cut = self.write("cut.state", content[:1000], "wb")
        damaged = self.write("damaged.state", content[:-1] + bytes([content[-1] ^ 1]), "wb")
        version = content[8] + 1
        newer = self.write("newer.state", content[:8] + bytes([version]) + content[9:], "wb")
        for path, words in ((cut, ("at byte 1000", "%d bytes too early" % (len(content) - 1000))),
                            (damaged, ("damaged", "check sum")),
                            (newer, ("at byte 8", "version is %d" % version)),
                            (self.bag, ("at byte 0", "no state of a map")),
                            (self.path("none.state"), ("No such file",))):
            with self.subTest(path=path):
                result = self.slam("refused", "--state", path, code=2)
                self.expect(result, 2, path, *words)
                self.assertFalse(os.path.exists(self.path("refused", "map.pgm")))

    def test_a_robot_that_is_not_found_is_told(self):
        self.bag = self.path("ring.bag")
        made = run("simulate", "--world", "ring", "--out", self.bag, "--duration", 2, "--no-images")
        self.assertEqual(made.returncode, 0, made.stderr)
        result = self.slam("lost", "--state", self.state, "--localization", code=2)
        self.expect(result, 2, "ring.bag", "was not found in the map of", self.state)

    def test_localization_needs_a_map(self):
        self.expect(self.slam("usage", "--localization", code=1), 1, "--state")

    def test_a_state_that_cannot_be_written_is_named(self):
        path = self.path("run.bag", "x.state")
        self.expect(self.slam("full", "--save-state", path, code=2), 2, self.path("run.bag"))


if __name__ == "__main__":
    unittest.main()
