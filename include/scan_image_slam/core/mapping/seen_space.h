#pragma once

#include "scan_image_slam/core/geometry/index_range.h"

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace scan_image_slam {

/// Where some keyframes have looked through: what is found there now contradicts them.
class SeenSpace {
 public:
  /// Cells of `cell_size` [m] between the corners `lower` and `upper` [m].
  SeenSpace(const Eigen::Vector2d& lower, const Eigen::Vector2d& upper, double cell_size);

  /// Enters a ray from the laser to the point that it has hit [m].
  void AddRay(const Eigen::Vector2d& from, const Eigen::Vector2d& to);

  /// True if rays have crossed the place and all cells around it.
  bool IsFree(const Eigen::Vector2d& place) const;

 private:
  double cell_size_;
  IndexRange x_;
  IndexRange y_;
  std::vector<bool> free_;
};

}  // namespace scan_image_slam
