#pragma once

#include "scan_image_slam/core/sensor/stamp.h"

#include <cmath>
#include <vector>

namespace scan_image_slam {

/// One sweep of a planar laser, with the fields and meanings of sensor_msgs/LaserScan.
struct LaserScan {
  Stamp stamp = 0;               ///< time of the first beam [ns]
  double angle_min = 0.0;        ///< bearing of the first beam in the laser frame [rad]
  double angle_increment = 0.0;  ///< [rad], negative for a clockwise sweep
  double time_increment = 0.0;   ///< between two beams, 0 if unknown [s]
  double range_min = 0.0;        ///< [m]
  double range_max = 0.0;        ///< [m]
  std::vector<float> ranges;     ///< [m], coded by REP-117

  double Bearing(std::size_t beam) const {
    return angle_min + static_cast<double>(beam) * angle_increment;
  }
};

/// What one range says, by REP-117.
enum class BeamReturn {
  kHit,       ///< range_min <= range <= range_max, finite and not zero: an obstacle
  kNoObject,  ///< +Inf or beyond range_max: nothing within reach
  kUnknown,   ///< NaN, -Inf, zero or below range_min: error, too near, or a driver's "no return"
};
inline BeamReturn Classify(double range, double range_min, double range_max) {
  if (range > range_max || (std::isinf(range) && range > 0.0)) return BeamReturn::kNoObject;
  return range > 0.0 && range >= range_min ? BeamReturn::kHit : BeamReturn::kUnknown;
}

}  // namespace scan_image_slam
