#include "scan_image_slam/core/calibration/range_jump.h"

#include <algorithm>
#include <cmath>

namespace scan_image_slam {
namespace {

/// Looks along the beams of a model in one direction (`step` +1 or -1).
class JumpFinder {
 public:
  JumpFinder(const FusedModel& model, const RangeJumpOptions& options, int step)
      : beams_(model.beams), options_(options), step_(step) {}

  /// The first beam beyond the surface that ends with beam `last`, or -1 if none ends there.
  int BeyondSurface(int last) const {
    if (!EndsSurface(last)) return -1;
    const int next = last + step_;
    const int after = next + step_;
    return IsBetween(last, next, after) ? after : IsBehind(last, next) ? next : -1;
  }

 private:
  bool Inside(int i) const { return i >= 0 && i < static_cast<int>(beams_.size()); }

  bool IsBehind(int near, int far) const {
    return Inside(far) && beams_[far].range > beams_[near].range + options_.min_depth;
  }

  /// A beam whose spot lies on two surfaces has a range between theirs.
  bool IsBetween(int near, int beam, int far) const {
    return IsBehind(near, far) && beams_[near].range < beams_[beam].range &&
           beams_[beam].range < beams_[far].range && !Connected(near, beam) &&
           !Connected(beam, far);
  }

  bool Connected(int a, int b) const {
    const double across = std::min(beams_[a].range, beams_[b].range) *
                          std::abs(beams_[b].bearing - beams_[a].bearing);
    constexpr double kNoise = 0.03;  // between two beams on one surface [m]
    return std::abs(beams_[a].range - beams_[b].range) <= kNoise + options_.max_slant * across;
  }

  bool EndsSurface(int last) const {
    for (int n = 0; n < options_.min_beams; ++n) {
      const int i = last - n * step_;
      if (!Inside(i) || !(beams_[i].range <= options_.max_range)) return false;  // NaN as well
      if (n > 0 && !Connected(i, i + step_)) return false;
    }
    return true;
  }

  const std::vector<ModelBeam>& beams_;
  const RangeJumpOptions& options_;
  int step_;
};

}  // namespace

std::vector<RangeJump> FindRangeJumps(const FusedModel& model, const RangeJumpOptions& options) {
  std::vector<RangeJump> jumps;
  for (int i = 0; i < static_cast<int>(model.beams.size()); ++i) {
    for (const int step : {-1, 1}) {
      const int beyond = JumpFinder(model, options, step).BeyondSurface(i);
      if (beyond < 0) continue;
      const ModelBeam& last = model.beams[i];
      const double gap =
          NormalizeAngle(model.HeadingOf(model.beams[beyond]) - model.HeadingOf(last));
      RangeJump jump;
      jump.heading = NormalizeAngle(model.HeadingOf(last) + 0.5 * gap);
      jump.range = last.range;
      jump.time_offset = last.time_offset;
      jump.side = gap > 0.0 ? 1 : -1;
      jump.stddev = std::abs(gap) / std::sqrt(12.0);
      jumps.push_back(jump);
    }
  }
  return jumps;
}

}  // namespace scan_image_slam
