#include "scan_image_slam/core/mapping/occupancy_grid.h"

#include "grid_fixtures.h"
#include "support_rooms.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

const Pose2 kOrigin;

using CellSet = std::set<std::pair<int, int>>;

CellSet KnownCells(const OccupancyGrid& grid) {
  CellSet cells;
  for (int y = grid.box().y.begin; y < grid.box().y.end; ++y) {
    for (int x = grid.box().x.begin; x < grid.box().x.end; ++x) {
      if (grid.Occupancy(x, y) >= 0) cells.insert({x, y});
    }
  }
  return cells;
}

/// Probability after so many hits and passes: the product of the odds (hit 3 : 1, pass 2 : 3).
int PercentOf(int hits, int passes) {
  const double odds = std::pow(3.0, hits) * std::pow(2.0 / 3.0, passes);
  return static_cast<int>(std::lround(100.0 * odds / (1.0 + odds)));
}

TEST(OccupancyGrid, IsUnknownEverywhereAtFirst) {
  const OccupancyGrid grid(MetreCells());
  EXPECT_EQ(grid.Occupancy(0, 0), -1);
  EXPECT_EQ(grid.Occupancy(-1000000, 1000000), -1);
  EXPECT_TRUE(grid.box().empty());
}

TEST(OccupancyGrid, ARayClearsTheCellsBeforeItsEndAndMarksTheEnd) {
  OccupancyGrid grid(MetreCells());
  grid.Add(OneBeam({0.5, 0.5}, {4.5, 0.5}), kOrigin);
  for (int x = 0; x < 4; ++x) EXPECT_EQ(grid.Occupancy(x, 0), 40) << x;
  EXPECT_EQ(grid.Occupancy(4, 0), 75);
  EXPECT_EQ(KnownCells(grid).size(), 5U);
}

TEST(OccupancyGrid, ABeamWithoutHitSaysNothingOfItsEnd) {
  OccupancyGrid grid(MetreCells());
  grid.Add(OneBeam({0.5, 0.5}, {0.5, -2.5}, false), kOrigin);
  EXPECT_EQ(KnownCells(grid), (CellSet{{0, 0}, {0, -1}, {0, -2}}));
  EXPECT_EQ(grid.Occupancy(0, -2), 40);
}

TEST(OccupancyGrid, TheRayStartsAtTheLaserOfTheMovedBase) {
  // The base at (10, -5) looks along y; the laser is 1 m ahead of it, the wall another 2 m.
  OccupancyGrid grid(MetreCells());
  grid.Add(OneBeam({1.0, 0.0}, {3.0, 0.0}), {10.5, -4.5, M_PI_2});
  EXPECT_EQ(KnownCells(grid), (CellSet{{10, -4}, {10, -3}, {10, -2}}));
  EXPECT_EQ(grid.Occupancy(10, -2), 75);
}

TEST(OccupancyGrid, CellsAreAsLargeAsTheResolution) {
  OccupancyGridOptions options = MetreCells();
  options.resolution = 0.25;
  OccupancyGrid grid(options);
  grid.Add(OneBeam({0.1, 0.1}, {-0.6, 0.1}), kOrigin);  // cells count from the origin of the map
  EXPECT_EQ(KnownCells(grid), (CellSet{{0, 0}, {-1, 0}, {-2, 0}, {-3, 0}}));
  EXPECT_EQ(grid.Occupancy(-3, 0), 75);
}

TEST(OccupancyGrid, OddsMultiplyWithHitsAndPasses) {
  const GridScan hit = OneBeam({0.5, 0.5}, {3.5, 0.5});
  const GridScan pass = OneBeam({0.5, 0.5}, {5.5, 0.5});
  for (int hits = 0; hits < 5; ++hits) {
    for (int passes = 0; passes < 8; ++passes) {
      if (hits + passes == 0) continue;
      OccupancyGrid grid(MetreCells());
      for (int i = 0; i < hits; ++i) grid.Add(hit, kOrigin);
      for (int i = 0; i < passes; ++i) grid.Add(pass, kOrigin);
      EXPECT_EQ(grid.Occupancy(3, 0), PercentOf(hits, passes)) << hits << " " << passes;
    }
  }
}

TEST(OccupancyGrid, ACellCountsOncePerScan) {
  OccupancyGrid grid(MetreCells());
  GridScan scan;
  scan.origin = {0.5, 0.5};
  for (int i = 0; i < 10; ++i)
    scan.beams.push_back({{3.5F, 0.1F + 0.08F * static_cast<float>(i)}, true});
  grid.Add(scan, kOrigin);
  for (int x = 0; x < 3; ++x) EXPECT_EQ(grid.Occupancy(x, 0), 40) << x;
  EXPECT_EQ(grid.Occupancy(3, 0), 75);
}

TEST(OccupancyGrid, ACellWithAHitIsNotCrossedByTheSameScan) {
  // A post, and beams that pass it by on either side, drawn before and after.
  GridScan scan = OneBeam({0.5, 0.5}, {3.5, 0.5});
  scan.beams.insert(scan.beams.begin(), {{6.5, 0.6}, true});
  scan.beams.push_back({{6.5F, 0.4F}, true});
  OccupancyGrid grid(MetreCells());
  grid.Add(scan, kOrigin);
  EXPECT_EQ(grid.Occupancy(3, 0), 75);
  EXPECT_EQ(grid.Occupancy(4, 0), 40);
  EXPECT_EQ(grid.Occupancy(6, 0), 75);
}

TEST(OccupancyGrid, AHitInTheCellOfTheLaserIsAHit) {
  OccupancyGrid grid(MetreCells());
  grid.Add(OneBeam({0.2, 0.2}, {0.8, 0.8}), kOrigin);
  EXPECT_EQ(KnownCells(grid), (CellSet{{0, 0}}));
  EXPECT_EQ(grid.Occupancy(0, 0), 75);
}

/// Part of a line from a to b that lies in a cell widened by `margin`; negative: none.
double LengthInside(const Eigen::Vector2d& a, const Eigen::Vector2d& b, int x, int y,
                    double margin) {
  double begin = 0.0;
  double end = 1.0;
  const Eigen::Vector2d lower(x - margin, y - margin);
  for (int axis = 0; axis < 2; ++axis) {
    const double way = b[axis] - a[axis];
    double enter = (lower[axis] - a[axis]) / way;
    double leave = (lower[axis] + 1.0 + 2.0 * margin - a[axis]) / way;
    if (enter > leave) std::swap(enter, leave);
    begin = std::max(begin, enter);
    end = std::min(end, leave);
  }
  return (end - begin) * (b - a).norm();
}

TEST(OccupancyGrid, RaysInAllDirectionsCrossTheCellsThatTheyMeet) {
  TestRandom random(7);
  for (int trial = 0; trial < 300; ++trial) {
    const Eigen::Vector2d from(random.Uniform(-4.0, 4.0), random.Uniform(-4.0, 4.0));
    const Eigen::Vector2d to(random.Uniform(-9.0, 9.0), random.Uniform(-9.0, 9.0));
    OccupancyGrid grid(MetreCells());
    grid.Add(OneBeam(from, to), kOrigin);
    for (int y = -11; y < 11; ++y) {
      for (int x = -11; x < 11; ++x) {
        const bool known = grid.Occupancy(x, y) >= 0;
        // Corners that are only grazed may go either way.
        const bool crossed = LengthInside(from, to, x, y, -1e-9) > 0.0;
        const bool missed = LengthInside(from, to, x, y, 1e-9) < 0.0;
        EXPECT_FALSE(crossed && !known) << x << " " << y;
        EXPECT_FALSE(missed && known) << x << " " << y;
      }
    }
    EXPECT_EQ(
        grid.Occupancy(static_cast<int>(std::floor(to.x())), static_cast<int>(std::floor(to.y()))),
        75);
  }
}

TEST(OccupancyGrid, NeverWrapsAround) {
  OccupancyGrid grid(MetreCells());
  for (int i = 0; i < 65536; ++i) grid.Add(OneBeam({0.5, 0.5}, {1.5, 0.5}), kOrigin);
  EXPECT_EQ(grid.Occupancy(0, 0), 0);
  EXPECT_EQ(grid.Occupancy(1, 0), 100);
}

std::string ErrorOf(const OccupancyGridOptions& options) {
  try {
    OccupancyGrid grid(options);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(OccupancyGridOptions, NamesTheFieldThatIsOutOfRange) {
  const double nan = std::nan("");
  for (const double value : {0.0, -0.05, nan, HUGE_VAL}) {
    OccupancyGridOptions options;
    options.resolution = value;
    EXPECT_EQ(ErrorOf(options).find("resolution"), 0U) << value;
  }
  for (const double value : {0.5, 1.0, -1.0, nan}) {
    OccupancyGridOptions options;
    options.update_factor_occupied = value;
    EXPECT_EQ(ErrorOf(options).find("update_factor_occupied"), 0U) << value;
  }
  for (const double value : {0.0, 0.5, 0.9, nan}) {
    OccupancyGridOptions options;
    options.update_factor_free = value;
    EXPECT_EQ(ErrorOf(options).find("update_factor_free"), 0U) << value;
  }
  for (const double value : {0.0, -1.0, nan, HUGE_VAL}) {
    OccupancyGridOptions options;
    options.max_range = value;
    EXPECT_EQ(ErrorOf(options).find("max_range"), 0U) << value;
  }
  EXPECT_EQ(ErrorOf(OccupancyGridOptions()), "");
}

}  // namespace
}  // namespace scan_image_slam
