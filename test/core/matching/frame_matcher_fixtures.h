#pragma once

#include "scan_image_slam/core/matching/frame_matcher.h"
#include "support_rooms.h"

#include <cmath>
#include <limits>
#include <vector>

namespace scan_image_slam {

/// The paper's laser: beams of 0.25 degrees, of which the matcher picks what it needs.
inline TestLaser PaperLaser() {
  TestLaser laser;
  laser.beams = 1080;
  laser.field_of_view = 270.0 * M_PI / 180.0;
  return laser;
}

/// Steps of 10 mm and 0.005 rad, within +-30 mm and +-0.015 rad.
constexpr SearchWindow kWindow{0.03, 0.0, 0.015};

inline FrameMatcherOptions CoarseOptions() {
  FrameMatcherOptions options;
  options.grid = {0.01, 0.005, 1e-6};
  return options;
}

inline MotionPrediction Predicted(const Pose2& motion) {
  MotionPrediction prediction;
  prediction.motion = motion;
  prediction.dt = 0.025;
  prediction.from_encoders = true;
  prediction.window = kWindow;
  prediction.covariance = Eigen::Vector3d(0.01, 0.005, 0.02).cwiseAbs2().asDiagonal();
  return prediction;
}

/// Looks at the box and the far walls of the furnished room.
const Pose2 kPose{0.0, 0.2, 0.35};

inline MatchOutcome MatchAfter(const Room& room, const Pose2& pose, const Pose2& motion,
                               const Pose2& predicted) {
  FrameMatcher matcher(CoarseOptions());
  matcher.Start(ModelOf(room, pose, 0, PaperLaser()));
  return matcher.Match(ModelOf(room, pose * motion, 1, PaperLaser()), Predicted(predicted));
}

/// Beams one degree apart over a full turn; only those in `lit` (degrees) hit, at 2 m.
inline FusedModel ModelLitAt(const std::vector<int>& lit) {
  FusedModel model;
  for (int degree = -180; degree < 180; ++degree) {
    ModelBeam beam;
    beam.bearing = degree * M_PI / 180.0;
    beam.range = std::numeric_limits<double>::infinity();
    for (const int l : lit) {
      if (l == degree) beam.range = 2.0;
    }
    if (beam.hit()) {
      beam.point = 2.0 * Eigen::Vector2d(std::cos(beam.bearing), std::sin(beam.bearing));
    }
    model.beams.push_back(beam);
  }
  return model;
}

}  // namespace scan_image_slam
