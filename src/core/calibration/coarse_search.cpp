#include "scan_image_slam/core/calibration/coarse_search.h"

#include <algorithm>
#include <cmath>

namespace scan_image_slam {
namespace {

constexpr int kSmoothing = 2;  // steps of yaw to either side that support each other

struct Peak {
  double yaw = 0.0;
  double votes = -1.0;
};

/// Each pair of an edge and a discontinuity votes for the yaw that would put one on the other.
Peak VoteForYaw(const CalibrationData& data, const std::vector<JumpSight>& sights,
                const CalibrationVector& correction, const CoarseSearchOptions& options) {
  const int half = static_cast<int>(std::ceil(options.yaw / options.yaw_step)) + kSmoothing;
  std::vector<double> votes(2 * half + 1, 0.0);
  for (const JumpSight& sight : sights) {
    const Eigen::Vector2d to_jump = FromCamera(sight, data.camera, correction.data());
    const double bearing = std::atan2(to_jump.y(), to_jump.x());
    for (const ViewedEdge& edge : data.views[sight.view].edges) {
      const double residual = NormalizeAngle(edge.bearing - bearing);
      const int bin = half - static_cast<int>(std::lround(residual / options.yaw_step));
      if (bin >= 0 && bin < static_cast<int>(votes.size())) votes[bin] += 1.0;
    }
  }
  Peak peak;
  for (int i = kSmoothing; i + kSmoothing < static_cast<int>(votes.size()); ++i) {
    double sum = 0.0;
    for (int k = -kSmoothing; k <= kSmoothing; ++k) {
      sum += votes[i + k] * (kSmoothing + 1 - std::abs(k));
    }
    if (sum > peak.votes) peak = {(i - half) * options.yaw_step, sum};
  }
  return peak;
}

/// -limit ... limit, with 0 among them.
std::vector<double> Steps(double limit, double step) {
  std::vector<double> steps;
  const int count = static_cast<int>(std::floor(limit / step + 1e-9));
  for (int i = -count; i <= count; ++i) steps.push_back(i * step);
  return steps;
}

}  // namespace

std::vector<CalibrationVector> SearchCoarsely(const CalibrationData& data,
                                              const CoarseSearchOptions& options) {
  std::vector<CalibrationVector> candidates;
  for (const double time : Steps(options.time, options.time_step)) {
    const std::vector<JumpSight> sights = SightJumps(data, time);
    CalibrationVector best{};
    Peak highest;
    for (const double forward : Steps(options.forward, options.place_step)) {
      for (const double left : Steps(options.left, options.place_step)) {
        CalibrationVector correction{};
        correction[kForward] = forward;
        correction[kLeft] = left;
        correction[kTime] = time;
        const Peak peak = VoteForYaw(data, sights, correction, options);
        if (peak.votes <= highest.votes) continue;
        highest = peak;
        best = correction;
        best[kYaw] = peak.yaw;
      }
    }
    candidates.push_back(best);
  }
  return candidates;
}

}  // namespace scan_image_slam
