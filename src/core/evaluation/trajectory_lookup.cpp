#include "scan_image_slam/core/evaluation/trajectory_lookup.h"

#include "scan_image_slam/core/evaluation/stamp_text.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace scan_image_slam {
namespace {

void RequireNotNegative(double value, const char* name) {
  if (!(std::isfinite(value) && value >= 0.0)) {
    throw std::invalid_argument(std::string(name) + " must not be negative and must be finite");
  }
}

std::optional<Pose2> PoseWithin(const StampedPose& pose, Stamp stamp, double tolerance) {
  if (std::abs(Seconds(stamp - pose.stamp)) > tolerance) return std::nullopt;
  return pose.pose;
}

}  // namespace

void LookupLimits::Validate() const {
  RequireNotNegative(max_gap, "max_gap");
  RequireNotNegative(tolerance, "tolerance");
}

std::optional<Pose2> PoseAt(const Trajectory& trajectory, Stamp stamp, const LookupLimits& limits) {
  if (trajectory.empty()) return std::nullopt;
  const auto after =
      std::lower_bound(trajectory.begin(), trajectory.end(), stamp,
                       [](const StampedPose& pose, Stamp s) { return pose.stamp < s; });
  if (after == trajectory.end()) return PoseWithin(trajectory.back(), stamp, limits.tolerance);
  if (after == trajectory.begin()) return PoseWithin(trajectory.front(), stamp, limits.tolerance);
  const auto before = after - 1;
  const double gap = Seconds(after->stamp - before->stamp);
  const double fraction = Seconds(stamp - before->stamp) / gap;
  if (gap <= limits.max_gap) return Interpolate(before->pose, after->pose, fraction);
  return PoseWithin(fraction < 0.5 ? *before : *after, stamp, limits.tolerance);
}

std::string DescribeSpan(const Trajectory& trajectory) {
  if (trajectory.empty()) return "without poses";
  return "from " + FormatStamp(trajectory.front().stamp) + " to " +
         FormatStamp(trajectory.back().stamp);
}

}  // namespace scan_image_slam
