"""evaluate_map: a map against the plan of the simulated world, in one line of key=value pairs."""
import unittest

from tools import ToolTest, key_values, run

# A room of 4 m by 3 m around the robot, which stands at (2, 1) and looks along y; the laser sees all
# of its walls but a part of the one behind it. The map begins at the robot: x of the map is y - 1 of
# the world, y of the map is 2 - x.
WORLD = """
walls: [{id: room, points: [[0, 0], [4, 0], [4, 3], [0, 3]], closed: true}]
paths: [{start: [2, 1], heading_deg: 90, way_points: [[2, 2]]}]
"""
TRUTH = "".join("%d 2 1 0 0 0 0.707106781 0.707106781\n" % i for i in range(3))
CELL = 0.05
COLUMNS, ROWS = 70, 90  # from (-1.25, -2.25) of the map
YAML = """image: map.pgm
resolution: 0.05
origin: [-1.25, -2.25, 0.0]
negate: 0
occupied_thresh: 0.65
free_thresh: 0.196
"""


def room():
    """The cells just outside the walls: column x covers -1.25 + 0.05 x and on."""
    sides = [(x, y) for y in (4, 85) for x in range(5, 65)]  # y of the map -2.05 ... -2, 2 ... 2.05
    return sides + [(x, y) for x in (4, 65) for y in range(5, 85)]  # x -1.05 ... -1, 2 ... 2.05


class EvaluateMap(ToolTest):
    def setUp(self):
        super().setUp()
        self.world = self.write("room.yaml", WORLD)
        self.truth = self.write("run.gt.tum", TRUTH)

    def map(self, occupied, yaml=YAML):
        pixels = [[254] * COLUMNS for _ in range(ROWS)]
        for x, y in occupied:
            pixels[ROWS - 1 - y][x] = 0
        header = b"P5\n%d %d\n255\n" % (COLUMNS, ROWS)
        self.write("map.pgm", header + b"".join(bytes(row) for row in pixels), "wb")
        return self.write("map.yaml", yaml)

    def evaluate(self, occupied, *options):
        return run("evaluate_map", self.world, self.truth, self.map(occupied), *options)

    def values(self, occupied, *options):
        result = self.evaluate(occupied, *options)
        self.expect(result, 0)
        self.assertEqual(result.stdout.count("\n"), 1)
        return {key: float(value) for key, value in key_values(result.stdout).items()}

    def test_perfect(self):
        values = self.values(room())
        self.assertEqual(values["occupied_cells"], 2 * 60 + 2 * 80)
        self.assertEqual(values["precision_percent"], 100.0)
        self.assertEqual(values["recall_percent"], 100.0)
        # All cells are half a cell behind their walls.
        self.assertAlmostEqual(values["wall_rms_m"], 0.025, places=5)
        self.assertAlmostEqual(values["wall_offset_m"], 0.025, places=5)
        self.assertAlmostEqual(values["wall_thickness_m"], 0.0, places=5)

    def test_false_cells(self):
        blot = [(x, y) for x in range(30, 40) for y in range(40, 47)]  # 70 in the middle of the room
        values = self.values(room() + blot)
        self.assertAlmostEqual(values["precision_percent"], 100.0 * 280 / 350, places=4)
        self.assertEqual(values["recall_percent"], 100.0)

    def test_missing_wall(self):
        values = self.values([cell for cell in room() if cell[0] != 65])  # that ahead of the robot
        self.assertEqual(values["precision_percent"], 100.0)
        # 80 of 60 + 60 + 80 cells and those of the wall behind, of which the laser sees the ends.
        self.assertLess(values["recall_percent"], 100.0 * 200 / 280)
        self.assertGreater(values["recall_percent"], 100.0 * 120 / 200)

    def test_pose_of_the_map(self):
        moved = YAML.replace("[-1.25, -2.25,", "[0.0, 0.0,")
        self.assertLess(self.values(room())["wall_offset_m"], 0.03)
        path = self.map(room(), moved)  # now (1.25, 2.25) of the map is where the robot begins
        result = run("evaluate_map", self.world, self.truth, path)
        self.assertLess(float(key_values(result.stdout)["precision_percent"]), 50.0)
        # World (2, 1) - turned by 90 degrees (1.25, 2.25) = (2 + 2.25, 1 - 1.25).
        result = run("evaluate_map", self.world, self.truth, path, "--pose", "4.25", "-0.25", "90")
        self.expect(result, 0)
        self.assertEqual(float(key_values(result.stdout)["precision_percent"]), 100.0)

    def test_tolerance(self):
        far = [(x, 3) for x in range(5, 65)]  # centres 7.5 cm behind the wall
        self.assertEqual(self.values(far)["precision_percent"], 0.0)
        self.assertEqual(self.values(far, "--tolerance", "0.08")["precision_percent"], 100.0)

    def test_plot(self):
        picture = self.path("agreement.png")
        self.expect(self.evaluate(room(), "--plot", picture), 0)
        with open(picture, "rb") as file:
            self.assertEqual(file.read(8), b"\x89PNG\r\n\x1a\n")
        for wrong in (self.path("none", "x.png"), self.path("x.nothing")):
            self.expect(self.evaluate(room(), "--plot", wrong), 2, wrong)

    def test_an_empty_map_has_no_precision(self):
        result = self.evaluate([])
        self.expect(result, 0)
        self.assertEqual(key_values(result.stdout)["precision_percent"], "nan")
        self.assertEqual(float(key_values(result.stdout)["recall_percent"]), 0.0)

    def test_unusable_input(self):
        path = self.map(room())
        self.expect(run("evaluate_map", "atlantis", self.truth, path), 2, "atlantis")
        missing = self.path("none.tum")
        self.expect(run("evaluate_map", self.world, missing, path), 2, missing)
        self.expect(run("evaluate_map", self.world, self.truth, missing), 2, missing)
        no_size = self.map(room(), YAML.replace("resolution", "size"))
        self.expect(run("evaluate_map", self.world, self.truth, no_size), 2, "map.yaml", "resolution")

    def test_truth_of_another_world(self):
        self.write("run.gt.tum", TRUTH.replace(" 2 1 ", " 500 1 "))
        self.expect(self.evaluate(room()), 2, "room.yaml", "run.gt.tum", "belong together")

    def test_wrong_usage(self):
        self.expect(self.evaluate(room(), "--tolerance", "0"), 1, "tolerance")
        self.expect(self.evaluate(room(), "--pose", "1", "2"), 1, "--pose")
        self.expect(self.evaluate(room(), "--pose", "1", "2", "nan"), 1, "--pose")


if __name__ == "__main__":
    unittest.main()
