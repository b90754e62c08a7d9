#pragma once

#include "scan_image_slam/core/mapping/occupancy_grid.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace scan_image_slam {

/// A grid to compute by hand in: cells of 1 m, odds of 3 : 1 for a hit and 2 : 3 for a pass.
inline OccupancyGridOptions MetreCells() {
  OccupancyGridOptions options;
  options.resolution = 1.0;
  options.update_factor_occupied = 0.75;
  options.update_factor_free = 0.4;
  options.max_range = 30.0;
  return options;
}

inline GridScan OneBeam(const Eigen::Vector2d& from, const Eigen::Vector2d& to, bool hit = true) {
  GridScan scan;
  scan.origin = from;
  scan.beams.push_back({to.cast<float>(), hit});
  return scan;
}

/// Compares cell by cell, also where only one of the grids holds the cell.
inline void ExpectSameOccupancy(const OccupancyGrid& a, const OccupancyGrid& b) {
  const auto unite = [](const IndexRange& i, const IndexRange& j) {
    return IndexRange{std::min(i.begin, j.begin), std::max(i.end, j.end)};
  };
  const CellBox box{unite(a.box().x, b.box().x), unite(a.box().y, b.box().y)};
  int different = 0;
  for (int y = box.y.begin; y < box.y.end; ++y) {
    for (int x = box.x.begin; x < box.x.end; ++x) {
      different += a.Occupancy(x, y) != b.Occupancy(x, y) ? 1 : 0;
    }
  }
  EXPECT_EQ(different, 0) << "cells";
}

}  // namespace scan_image_slam
