#include "scan_image_slam/core/mapping/drawn_map.h"

#include "grid_fixtures.h"
#include "support_rooms.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

constexpr int kAll = std::numeric_limits<int>::max();

/// A scan of a few beams in any direction, on a keyframe that lies at the map's origin.
DrawnScan AnyScan(const Pose2& map_from_base, TestRandom* random) {
  auto scan = std::make_shared<GridScan>();
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector2d end(random->Uniform(-9.0, 9.0), random->Uniform(-9.0, 9.0));
    scan->beams.push_back({end.cast<float>(), true});
  }
  return {scan, {0, map_from_base}, map_from_base};
}

OccupancyGrid GridOf(const std::vector<DrawnScan>& scans) {
  OccupancyGrid grid(MetreCells());
  for (const DrawnScan& scan : scans) grid.Add(*scan.scan, scan.map_from_base);
  return grid;
}

/// Somewhere in the place that reaches from (1, 2) to (1.5, 2.5) and from 0 to 45 degrees.
Pose2 Somewhere(TestRandom* random) {
  return {random->Uniform(1.01, 1.49), random->Uniform(2.01, 2.49), random->Uniform(0.01, 0.78)};
}

TEST(DrawnMap, OfOnePlaceTheLatestScansMakeTheMap) {
  TestRandom random(1);
  DrawnMap map(MetreCells(), 3);
  std::vector<DrawnScan> scans;
  for (int i = 0; i < 7; ++i) {
    scans.push_back(AnyScan(Somewhere(&random), &random));
    map.Add(scans.back());
  }
  EXPECT_EQ(map.size(), 3U);
  ExpectSameOccupancy(map.grid(), GridOf({scans.end() - 3, scans.end()}));
}

TEST(DrawnMap, OtherPlacesAndDirectionsAreLeftAlone) {
  TestRandom random(2);
  DrawnMap map(MetreCells(), 1);
  std::vector<DrawnScan> scans;
  for (const Pose2& pose : {Pose2{1.2, 2.2, 0.1}, Pose2{1.6, 2.2, 0.1}, Pose2{1.2, 1.9, 0.1},
                            Pose2{1.2, 2.2, -0.1}, Pose2{1.2, 2.2, 1.0}, Pose2{-1.2, 2.2, 0.1}}) {
    scans.push_back(AnyScan(pose, &random));
    map.Add(scans.back());
  }
  EXPECT_EQ(map.size(), scans.size());
  ExpectSameOccupancy(map.grid(), GridOf(scans));
}

TEST(DrawnMap, WhatHasLeftThePlaceFadesFromTheMap) {
  DrawnMap map(MetreCells(), 3);
  const Pose2 pose{0.4, 0.4, 0.1};
  const auto here = std::make_shared<GridScan>(OneBeam({0, 0}, {3, 0}));
  const auto gone = std::make_shared<GridScan>(OneBeam({0, 0}, {6, 0}));
  for (int i = 0; i < 100; ++i) map.Add({here, {-1, pose}, pose});
  EXPECT_GT(map.grid().Occupancy(3, 0), 90);
  for (int i = 0; i < 3; ++i) map.Add({gone, {-1, pose}, pose});
  EXPECT_LT(map.grid().Occupancy(3, 0), 30);
}

TEST(DrawnMap, AScanThatMovesCountsWhereItLies) {
  TestRandom random(3);
  DrawnMap map(MetreCells(), 2);
  std::vector<DrawnScan> scans;
  for (int i = 0; i < 2; ++i) {
    scans.push_back(AnyScan(Somewhere(&random), &random));
    map.Add(scans.back());
  }
  const Pose2 moved{10.0, 0.0, 0.0};
  map.BeginRedraw();
  EXPECT_FALSE(map.Redraw({{0, moved}}, 1));
  EXPECT_TRUE(map.Redraw({{0, moved}}, kAll));
  for (DrawnScan& scan : scans) scan.map_from_base = moved * scan.map_from_base;
  ExpectSameOccupancy(map.grid(), GridOf(scans));
  // The place that they have left has room again, the one that they came to is full.
  for (int i = 0; i < 2; ++i) {
    scans.push_back(AnyScan(Somewhere(&random), &random));
    map.Add(scans.back());
  }
  EXPECT_EQ(map.size(), 4U);
  scans.push_back(AnyScan(moved * Somewhere(&random), &random));
  map.Add(scans.back());
  EXPECT_EQ(map.size(), 4U);
  scans.erase(scans.begin());
  ExpectSameOccupancy(map.grid(), GridOf(scans));
}

TEST(DrawnMap, GoesOnFromItsScansAsIfItHadNotStopped) {
  TestRandom random(4);
  DrawnMap whole(MetreCells(), 3);
  DrawnMap loaded(MetreCells(), 3);
  for (int i = 0; i < 60; ++i) {
    if (i == 40) loaded.Load(whole.scans());
    const Pose2 pose{random.Uniform(0.0, 1.5), 0.2, 0.1};
    const DrawnScan scan = AnyScan(pose, &random);
    whole.Add(scan);
    if (i >= 40) loaded.Add(scan);
  }
  EXPECT_EQ(whole.size(), 9U);
  EXPECT_EQ(loaded.size(), 9U);
  ExpectSameOccupancy(loaded.grid(), whole.grid());
}

TEST(DrawnMap, AScanThatWouldMakeItTooLargeChangesNothing) {
  OccupancyGridOptions options = MetreCells();
  options.max_cells = 20000;
  TestRandom random(5);
  DrawnMap map(options, 1);
  const DrawnScan scan = AnyScan(Somewhere(&random), &random);
  map.Add(scan);
  const Pose2 far{1.2, 2.2, 0.2};
  EXPECT_THROW(map.Add({std::make_shared<GridScan>(OneBeam({0, 0}, {9000, 0})), {-1, far}, far}),
               std::invalid_argument);
  EXPECT_EQ(map.size(), 1U);
  ExpectSameOccupancy(map.grid(), GridOf({scan}));
}

}  // namespace
}  // namespace scan_image_slam
