"""two_machines.py: the robot and its base station on both sides of a link that is cut for a while."""
import json
import os
import re
import subprocess
import unittest

from tools import ToolTest, read, read_tum

SCRIPT = os.path.join(os.environ["SCAN_IMAGE_SLAM_SOURCE"], "scripts", "two_machines.py")
CUT = 6.0  # [s]


class TwoMachines(ToolTest):
    def test_the_pose_is_right_after_a_cut(self):
        result = subprocess.run(
            [SCRIPT, "--only", "cut", "--cut", str(CUT), "--duration", "20", "--out", self.folder],
            text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=300)
        if result.returncode == 2:
            self.skipTest(result.stderr.strip())
        log = os.path.join(self.folder, "cut", "log")
        self.assertEqual(result.returncode, 0, result.stderr + read(log))
        row = result.stdout.splitlines()[-1]
        self.assertIn("cut for 6 s", row)
        worst = float(re.search(r"([0-9.]+) mm \|$", row).group(1))
        self.assertLess(worst, 30.0, row)
        online = [float(r[0]) for r in read_tum(os.path.join(self.folder, "cut", "online.tum"))]
        gaps = [b - a for a, b in zip(online, online[1:])]
        # What was sent meanwhile is lost, or comes late: as much as fits into the buffers of TCP.
        late = json.loads(read(os.path.join(self.folder, "cut", "latency.json")))["latency_ms"]["max"]
        self.assertGreater(max(max(gaps), 1e-3 * late), CUT / 2, "the link was cut")
        if max(gaps) > CUT / 2:
            gap = gaps.index(max(gaps))
            self.assertGreater(online[-1] - online[gap + 1], 1.0, "poses came after the cut")


if __name__ == "__main__":
    unittest.main()
