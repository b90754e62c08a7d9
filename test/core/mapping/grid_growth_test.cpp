// What adding, growing and removing leave as it was.
#include "grid_fixtures.h"
#include "scan_image_slam/core/mapping/occupancy_grid.h"
#include "support_rooms.h"

#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

const Pose2 kOrigin;

struct PlacedScan {
  GridScan scan;
  Pose2 map_from_base;
};

/// Scans of everything a scan may hold, from places all around.
std::vector<PlacedScan> RandomScans(int count) {
  TestRandom random(11);
  std::vector<PlacedScan> scans;
  for (int i = 0; i < count; ++i) {
    PlacedScan placed;
    placed.map_from_base = {random.Uniform(-60.0, 60.0), random.Uniform(-60.0, 60.0),
                            random.Uniform(-M_PI, M_PI)};
    placed.scan.origin = {random.Uniform(-0.5, 0.5), random.Uniform(-0.5, 0.5)};
    for (int beam = 0; beam < 40; ++beam) {
      const Eigen::Vector2d end(random.Uniform(-30.0, 30.0), random.Uniform(-30.0, 30.0));
      placed.scan.beams.push_back({end.cast<float>(), random.Uniform(0.0, 1.0) < 0.7});
    }
    scans.push_back(placed);
  }
  return scans;
}

bool Contains(const CellBox& box, int x, int y) { return box.x.Contains(x) && box.y.Contains(y); }

TEST(GridSize, IsBounded) {
  OccupancyGridOptions options = MetreCells();
  options.max_cells = 300 * 300;
  OccupancyGrid grid(options);
  const GridScan scan = OneBeam({0.0, 0.0}, {5.5, 0.5});
  grid.Add(scan, kOrigin);
  OccupancyGrid expected = grid;
  // Wherever a scan lies that would make the grid too large, or that no grid holds.
  for (const Pose2& far : {Pose2{0.0, 1000.0, 0.0}, Pose2{-1000.0, 0.0, 0.0},
                           Pose2{1e300, 0.0, 0.0}, Pose2{0.0, -1e300, 0.0}}) {
    EXPECT_THROW(grid.Add(scan, far), std::invalid_argument);
  }
  ExpectSameOccupancy(grid, expected);
  grid.Add(scan, {10.0, 10.0, 0.0});
  EXPECT_GT(grid.Occupancy(15, 10), 50);
}

class GridGrowth : public ::testing::TestWithParam<Pose2> {};

TEST_P(GridGrowth, KeepsWhatItHolds) {
  OccupancyGrid grid(MetreCells());
  OccupancyGrid expected(MetreCells());
  const GridScan scan = RandomScans(1).front().scan;
  expected.Add(scan, kOrigin);
  grid.Add(scan, kOrigin);
  // The beam has no cells of its own: it begins and ends where it adds nothing.
  const CellBox before = grid.box();
  GridScan far = OneBeam({0.1, 0.1}, {0.2, 0.2}, false);
  grid.Add(far, GetParam());
  EXPECT_TRUE(Contains(grid.box(), static_cast<int>(GetParam().x), static_cast<int>(GetParam().y)));
  EXPECT_FALSE(Contains(before, static_cast<int>(GetParam().x), static_cast<int>(GetParam().y)));
  ExpectSameOccupancy(grid, expected);
}

INSTANTIATE_TEST_SUITE_P(Directions, GridGrowth,
                         ::testing::Values(Pose2{300.0, 0.0, 0.0}, Pose2{-300.0, 0.0, 0.0},
                                           Pose2{0.0, 300.0, 0.0}, Pose2{0.0, -300.0, 0.0},
                                           Pose2{300.0, -200.0, 0.0}, Pose2{-300.0, 200.0, 0.0}));

TEST(OccupancyGridProperty, TheOrderOfScansDoesNotMatter) {
  const std::vector<PlacedScan> scans = RandomScans(30);
  OccupancyGrid forward(MetreCells());
  OccupancyGrid backward(MetreCells());
  for (auto it = scans.begin(); it != scans.end(); ++it) forward.Add(it->scan, it->map_from_base);
  for (auto it = scans.rbegin(); it != scans.rend(); ++it) {
    backward.Add(it->scan, it->map_from_base);
  }
  ExpectSameOccupancy(forward, backward);
}

TEST(OccupancyGridProperty, TheOrderOfBeamsDoesNotMatter) {
  OccupancyGrid forward(MetreCells());
  OccupancyGrid backward(MetreCells());
  for (PlacedScan& placed : RandomScans(10)) {
    forward.Add(placed.scan, placed.map_from_base);
    std::reverse(placed.scan.beams.begin(), placed.scan.beams.end());
    backward.Add(placed.scan, placed.map_from_base);
  }
  ExpectSameOccupancy(forward, backward);
}

TEST(OccupancyGridProperty, RemovingUndoesAdding) {
  const std::vector<PlacedScan> scans = RandomScans(30);
  OccupancyGrid rest(MetreCells());
  OccupancyGrid grid(MetreCells());
  for (std::size_t i = 0; i < scans.size(); ++i) {
    grid.Add(scans[i].scan, scans[i].map_from_base);
    if (i % 3 == 0) rest.Add(scans[i].scan, scans[i].map_from_base);
  }
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if (i % 3 != 0) grid.Remove(scans[i].scan, scans[i].map_from_base);
  }
  ExpectSameOccupancy(grid, rest);
}

TEST(OccupancyGridProperty, RemovingAllLeavesNothingKnown) {
  OccupancyGrid grid(MetreCells());
  const std::vector<PlacedScan> scans = RandomScans(5);
  for (const PlacedScan& placed : scans) grid.Add(placed.scan, placed.map_from_base);
  for (const PlacedScan& placed : scans) grid.Remove(placed.scan, placed.map_from_base);
  ExpectSameOccupancy(grid, OccupancyGrid(MetreCells()));
}

TEST(GridChanges, HoldEveryCellThatHasChanged) {
  OccupancyGrid grid(MetreCells());
  for (const PlacedScan& placed : RandomScans(20)) {
    const OccupancyGrid before = grid;
    grid.Add(placed.scan, placed.map_from_base);
    const CellBox changes = grid.TakeChanges();
    EXPECT_FALSE(changes.empty());
    for (int y = grid.box().y.begin; y < grid.box().y.end; ++y) {
      for (int x = grid.box().x.begin; x < grid.box().x.end; ++x) {
        if (grid.Occupancy(x, y) == before.Occupancy(x, y)) continue;
        EXPECT_TRUE(Contains(changes, x, y)) << x << " " << y;
      }
    }
  }
}

TEST(GridChanges, AreToldOnce) {
  OccupancyGrid grid(MetreCells());
  EXPECT_TRUE(grid.TakeChanges().empty());
  grid.Add(OneBeam({0.5, 0.5}, {3.5, 0.5}), kOrigin);
  EXPECT_FALSE(grid.TakeChanges().empty());
  EXPECT_TRUE(grid.TakeChanges().empty());
}

TEST(GridChanges, AddUpUntilTheyAreTaken) {
  OccupancyGrid grid(MetreCells());
  grid.Add(OneBeam({0.5, 0.5}, {3.5, 0.5}), kOrigin);
  grid.Add(OneBeam({-40.5, 7.5}, {-43.5, 7.5}), kOrigin);
  const CellBox changes = grid.TakeChanges();
  EXPECT_TRUE(Contains(changes, 3, 0));
  EXPECT_TRUE(Contains(changes, -44, 7));
  grid.Add(OneBeam({0.5, 0.5}, {3.5, 0.5}), kOrigin);
  EXPECT_FALSE(Contains(grid.TakeChanges(), -44, 7));
}

}  // namespace
}  // namespace scan_image_slam
