#pragma once

#include "scan_image_slam/core/fusion/fused_model.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace scan_image_slam {

/// Angle between two beams, the short way: the first beam of a full turn is next to the last [rad].
inline double AngleBetween(const ModelBeam& a, const ModelBeam& b) {
  return std::abs(NormalizeAngle(b.bearing - a.bearing));
}

/// Usual angle between two successive beams, wherever the field of view has cut some out [rad].
inline double BeamSpacing(const std::vector<ModelBeam>& beams) {
  double spacing = M_PI;
  for (std::size_t i = 1; i < beams.size(); ++i) {
    spacing = std::min(spacing, AngleBetween(beams[i - 1], beams[i]));
  }
  return spacing;
}

}  // namespace scan_image_slam
