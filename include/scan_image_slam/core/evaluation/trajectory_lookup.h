#pragma once

#include "scan_image_slam/core/evaluation/trajectory.h"

#include <optional>

namespace scan_image_slam {

/// When a trajectory is taken to know the pose at a time.
struct LookupLimits {
  double max_gap = 0.25;    ///< between two poses that are still interpolated [s]
  double tolerance = 1e-4;  ///< to a pose that is taken as it is where none can be interpolated [s]
  /// Throws std::invalid_argument, naming the field, if a value is negative or not finite.
  void Validate() const;
};

/// Pose at `stamp`: interpolated with constant velocity if the poses before and after it are close
/// to each other, else the nearest pose if it is close to `stamp`, else nothing.
std::optional<Pose2> PoseAt(const Trajectory& trajectory, Stamp stamp, const LookupLimits& limits);

/// `from 1.000000000 to 9.500000000`, for messages about times that do not meet.
std::string DescribeSpan(const Trajectory& trajectory);

}  // namespace scan_image_slam
