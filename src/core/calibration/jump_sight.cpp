#include "scan_image_slam/core/calibration/jump_sight.h"

#include "scan_image_slam/core/evaluation/trajectory_lookup.h"

#include <optional>

namespace scan_image_slam {

std::vector<JumpSight> SightJumps(const CalibrationData& data, double time_offset) {
  // Longer than the noise of single poses, shorter than changes of the velocity.
  constexpr double kHalfSpan = 0.05;  // [s]
  const LookupLimits limits;
  std::vector<JumpSight> sights;
  for (int v = 0; v < static_cast<int>(data.views.size()); ++v) {
    const CalibrationView& view = data.views[v];
    const Stamp stamp = view.stamp + FromSeconds(time_offset);
    const std::optional<Pose2> now = PoseAt(data.trajectory, stamp, limits);
    const std::optional<Pose2> before =
        PoseAt(data.trajectory, stamp - FromSeconds(kHalfSpan), limits);
    const std::optional<Pose2> after =
        PoseAt(data.trajectory, stamp + FromSeconds(kHalfSpan), limits);
    if (!now || !before || !after) continue;
    const Velocity2 velocity = VelocityOf(before->Inverse() * *after, 2.0 * kHalfSpan);
    for (const ViewedJump& jump : view.jumps) {
      const std::optional<Pose2> fired = PoseAt(data.trajectory, jump.fired, limits);
      if (!fired) continue;
      sights.push_back({v, now->Inverse() * *fired * jump.in_base, velocity, time_offset, jump.side,
                        jump.bearing_stddev});
    }
  }
  return sights;
}

std::vector<CalibrationPair> PairNearest(const CalibrationData& data,
                                         const std::vector<JumpSight>& sights,
                                         const CalibrationVector& correction, double gate) {
  std::vector<CalibrationPair> pairs;
  for (const JumpSight& sight : sights) {
    const ViewedEdge* nearest = nullptr;
    double least = gate;
    for (const ViewedEdge& edge : data.views[sight.view].edges) {
      const double residual =
          std::abs(BearingResidual(sight, edge, data.camera, correction.data()));
      if (residual >= least) continue;
      least = residual;
      nearest = &edge;
    }
    if (nearest != nullptr) pairs.push_back({sight, *nearest});
  }
  return pairs;
}

}  // namespace scan_image_slam
