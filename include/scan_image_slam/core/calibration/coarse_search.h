#pragma once

#include "scan_image_slam/core/calibration/jump_sight.h"

#include <vector>

namespace scan_image_slam {

/// How wrong what is assumed may be, to either side, and the steps in which it is searched.
struct CoarseSearchOptions {
  double yaw = 0.12;         ///< [rad]
  double yaw_step = 0.002;   ///< [rad]
  double forward = 0.08;     ///< [m]
  double left = 0.08;        ///< [m]
  double place_step = 0.04;  ///< [m]
  double time = 0.06;        ///< [s]
  double time_step = 0.015;  ///< [s]
};

/// For each time offset the yaw and the place for which most edges lie on discontinuities, by a
/// vote of all pairs of them. A delay looks much like a yaw on a drive that turns one way, so that
/// only a finer fit tells which of them is right.
std::vector<CalibrationVector> SearchCoarsely(const CalibrationData& data,
                                              const CoarseSearchOptions& options);

}  // namespace scan_image_slam
