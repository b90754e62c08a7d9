#pragma once

#include <cmath>
#include <cstdlib>
#include <limits>

#include <Eigen/Core>

namespace scan_image_slam {

/// Calls `visit(x, y)` for each cell on the straight line from one place to another, both in cells,
/// without the cell of the end (Amanatides and Woo 1987).
template <typename Visit>
void ForEachCellBefore(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const Visit& visit) {
  int x = static_cast<int>(std::floor(from.x()));
  int y = static_cast<int>(std::floor(from.y()));
  const int end_x = static_cast<int>(std::floor(to.x()));
  const int end_y = static_cast<int>(std::floor(to.y()));
  const Eigen::Vector2d d = to - from;
  const int step_x = d.x() > 0.0 ? 1 : -1;
  const int step_y = d.y() > 0.0 ? 1 : -1;
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const double delta_x = d.x() != 0.0 ? std::abs(1.0 / d.x()) : kNever;
  const double delta_y = d.y() != 0.0 ? std::abs(1.0 / d.y()) : kNever;
  double next_x = d.x() != 0.0 ? (x + (step_x > 0 ? 1 : 0) - from.x()) / d.x() : kNever;
  double next_y = d.y() != 0.0 ? (y + (step_y > 0 ? 1 : 0) - from.y()) / d.y() : kNever;
  for (int left = std::abs(end_x - x) + std::abs(end_y - y); left > 0; --left) {
    visit(x, y);
    if (next_x < next_y) {
      next_x += delta_x;
      x += step_x;
    } else {
      next_y += delta_y;
      y += step_y;
    }
  }
}

}  // namespace scan_image_slam
