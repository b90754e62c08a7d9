#pragma once

#include "scan_image_slam/core/fusion/fused_model.h"

#include <vector>

namespace scan_image_slam {

struct RangeJumpOptions {
  double min_depth = 0.3;  ///< between the ranges on both sides [m]
  double max_range = 6.0;  ///< of the nearer surface; farther ones are seen by too few beams [m]
  int min_beams = 3;       ///< of the nearer surface: fewer may be dust or beams between surfaces
  double max_slant = 5.0;  ///< tangent of the incidence up to which neighbours are one surface
};

/// Where a near surface ends beside a farther one: a vertical edge that the laser feels, too.
struct RangeJump {
  double heading = 0.0;      ///< in the base frame, between the surface and what is beside it [rad]
  double range = 0.0;        ///< of the last beam on the nearer surface [m]
  double time_offset = 0.0;  ///< when that beam was fired, since the stamp of the model [s]
  int side = 0;              ///< +1: the surface ends to the left; -1: to the right
  double stddev = 0.0;       ///< of the heading, by the distance between beams [rad]
};

/// The range discontinuities of a model, in the order of its beams. One beam between the surfaces,
/// whose spot lies on both, is bridged.
std::vector<RangeJump> FindRangeJumps(const FusedModel& model, const RangeJumpOptions& options);

}  // namespace scan_image_slam
