#pragma once

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

namespace scan_image_slam {

/// Line through points by total least squares.
struct Line {
  Eigen::Vector2d centre{0, 0};  ///< mean of the points [m]
  Eigen::Vector2d normal{0, 0};  ///< unit vector; zero if all points coincide
  double variance = 0.0;         ///< of the points across the line, unbiased [m^2]
  double spread = 0.0;           ///< sum of squared distances from the centre along the line [m^2]
};

/// Sums over points. Differences of running sums are the sums over any stretch of a sequence, so
/// lines through many stretches cost the same, however long they are.
struct PointSums {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;

  PointSums Plus(const Eigen::Vector2d& p) const {
    return {n + 1.0,           x + p.x(), y + p.y(), xx + p.x() * p.x(), xy + p.x() * p.y(),
            yy + p.y() * p.y()};
  }
  PointSums operator-(const PointSums& o) const {
    return {n - o.n, x - o.x, y - o.y, xx - o.xx, xy - o.xy, yy - o.yy};
  }
};

/// The line through at least three points, given their sums.
inline Line FitLine(const PointSums& s) {
  Line line;
  line.centre = {s.x / s.n, s.y / s.n};
  const double cxx = s.xx - s.x * line.centre.x();
  const double cxy = s.xy - s.x * line.centre.y();
  const double cyy = s.yy - s.y * line.centre.y();
  const double mean = 0.5 * (cxx + cyy);
  const double half_difference = 0.5 * (cxx - cyy);
  const double root = std::sqrt(half_difference * half_difference + cxy * cxy);
  line.variance = std::max(0.0, mean - root) / (s.n - 2.0);
  line.spread = mean + root;
  // Two vectors along the line, by the two rows of the scatter matrix; the longer one is exact.
  const Eigen::Vector2d along = half_difference >= 0.0
                                    ? Eigen::Vector2d(root + half_difference, cxy)
                                    : Eigen::Vector2d(cxy, root - half_difference);
  const double length = along.norm();
  constexpr double kRounding = 1e-12;  // of the sums
  if (length > kRounding * (s.xx + s.yy))
    line.normal = Eigen::Vector2d(-along.y(), along.x()) / length;
  return line;
}

}  // namespace scan_image_slam
