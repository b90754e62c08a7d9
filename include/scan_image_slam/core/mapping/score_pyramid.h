#pragma once

#include "scan_image_slam/core/geometry/pose2.h"

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace scan_image_slam {

struct ScorePyramidOptions {
  double cell_size = 0.1;  ///< [m]
  double reach = 0.2;      ///< points farther from the map than this score nothing [m]
  int levels = 6;          ///< level h bounds blocks of 2^h x 2^h cells
};

/// How well places fit a map, 0 to 1, and upper bounds of it over ever larger blocks of cells: what
/// branch and bound needs (Hess et al. 2016; Olson 2009).
class ScorePyramid {
 public:
  ScorePyramid() = default;
  /// `places` are points of the map's surfaces [m].
  ScorePyramid(const std::vector<Eigen::Vector2d>& places, const ScorePyramidOptions& options);

  double cell_size() const { return options_.cell_size; }
  int levels() const { return static_cast<int>(levels_.size()); }
  Eigen::Vector2i CellOf(const Eigen::Vector2d& place) const {
    return ((place - origin_) / options_.cell_size).array().floor().cast<int>();
  }
  /// Largest score of the cells (x .. x + 2^level - 1, y .. y + 2^level - 1), in 1/255.
  int Bound(int level, int x, int y) const {
    const int shift = (1 << level) - 1;
    x += shift;
    y += shift;
    if (x < 0 || y < 0 || x >= width_ + shift || y >= height_ + shift) return 0;
    return levels_[level][static_cast<std::size_t>(y) * (width_ + shift) + x];
  }

 private:
  ScorePyramidOptions options_;
  Eigen::Vector2d origin_{0, 0};
  int width_ = 0;
  int height_ = 0;
  std::vector<std::vector<std::uint8_t>> levels_;
};

/// Box around a pose in which a search runs.
struct PoseWindow {
  Pose2 centre;
  double half_distance = 0.0;  ///< in x and in y [m]
  double half_angle = 0.0;     ///< [rad]
};

/// A pose found by a search and the mean score of the points there, 0 to 1.
struct ScoredPose {
  Pose2 map_from_base;
  double score = 0.0;
};

/// The pose in the window at which `points` [m] fit best, on a grid of the pyramid's cells and of
/// `angle_step` [rad]; nothing if none scores more than `min_score`. Poses less than
/// `exclude_distance` and `exclude_angle` from `exclude` are left out. Exact: equal to trying all.
struct SearchExclusion {
  Pose2 pose;
  double distance = 0.0;  ///< [m]
  double angle = 0.0;     ///< [rad]
};
std::optional<ScoredPose> SearchBest(const ScorePyramid& pyramid,
                                     const std::vector<Eigen::Vector2d>& points,
                                     const PoseWindow& window, double angle_step, double min_score,
                                     const std::optional<SearchExclusion>& exclusion = {});

}  // namespace scan_image_slam
