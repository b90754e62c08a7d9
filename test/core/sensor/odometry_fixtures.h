#pragma once

#include "scan_image_slam/core/sensor/odometry_buffer.h"

namespace scan_image_slam {

inline Stamp At(double seconds) { return FromSeconds(1000.0) + FromSeconds(seconds); }

/// Limits that are easy to compute with, unlike the defaults.
inline OdometryOptions Limits(double history) {
  OdometryOptions options;
  options.max_speed = 3.0;
  options.max_turn_rate = 7.0;
  options.max_extrapolation = 0.25;
  options.history = history;
  return options;
}

}  // namespace scan_image_slam
