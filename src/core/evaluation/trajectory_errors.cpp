#include "scan_image_slam/core/evaluation/trajectory_errors.h"

#include "scan_image_slam/core/evaluation/key_values.h"
#include "scan_image_slam/core/evaluation/trajectory_lookup.h"

#include <cmath>
#include <optional>
#include <stdexcept>

#include <Eigen/Core>

namespace scan_image_slam {
namespace {

constexpr double kWindowTolerance = 0.1;     // of the window's length
constexpr double kStartSpacing = 0.01;       // of the window's length
constexpr double kRounding = 1e-9;           // of the window's length
constexpr double kMinSquaredSpread = 1e-12;  // [m^2], below which positions have no direction

/// Absolute values of translation [m] and rotation [rad], collected before they are summarised.
struct ErrorList {
  std::vector<double> translation;
  std::vector<double> rotation;

  void Add(const Pose2& error) {
    translation.push_back(error.translation().norm());
    rotation.push_back(std::abs(error.theta));
  }
};

/// E of the RPE from pair `i` to pair `j`.
Pose2 RelativeError(const PosePair& i, const PosePair& j) {
  const Pose2 reference_motion = i.reference.Inverse() * j.reference;
  const Pose2 estimated_motion = i.estimate.Inverse() * j.estimate;
  return reference_motion.Inverse() * estimated_motion;
}

/// Way of the reference up to each pair [m].
std::vector<double> Travelled(const std::vector<PosePair>& pairs) {
  std::vector<double> travelled{0.0};
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    const Eigen::Vector2d step =
        pairs[i].reference.translation() - pairs[i - 1].reference.translation();
    travelled.push_back(travelled.back() + step.norm());
  }
  return travelled;
}

/// Time from the first pair to each pair [s].
std::vector<double> Elapsed(const std::vector<PosePair>& pairs) {
  std::vector<double> elapsed;
  elapsed.reserve(pairs.size());
  for (const PosePair& pair : pairs) elapsed.push_back(Seconds(pair.stamp - pairs.front().stamp));
  return elapsed;
}

/// RPE over windows in which `axis`, which has one value per pair and never falls, grows by
/// `length`.
RelativeErrors WindowErrors(const std::vector<PosePair>& pairs, const std::vector<double>& axis,
                            double length) {
  ErrorList errors;
  double next_start = axis.front();
  std::size_t end = 0;
  for (std::size_t start = 0; start < pairs.size(); ++start) {
    if (axis[start] < next_start) continue;
    const double target = axis[start] + length * (1.0 - kRounding);
    while (end < pairs.size() && axis[end] < target) ++end;
    if (end == pairs.size()) break;
    const bool before_is_nearer = target - axis[end - 1] < axis[end] - target;
    const std::size_t nearest = before_is_nearer ? end - 1 : end;
    if (std::abs(axis[nearest] - target) > kWindowTolerance * length) continue;
    errors.Add(RelativeError(pairs[start], pairs[nearest]));
    next_start = axis[start] + (kStartSpacing - kRounding) * length;
  }
  return {Summarize(errors.translation), Summarize(errors.rotation)};
}

/// Mean rotation from estimate to reference by the headings.
double MeanHeadingDifference(const std::vector<PosePair>& pairs) {
  Eigen::Vector2d sum(0.0, 0.0);
  for (const PosePair& pair : pairs) {
    const double difference = pair.reference.theta - pair.estimate.theta;
    sum += Eigen::Vector2d(std::cos(difference), std::sin(difference));
  }
  return std::atan2(sum.y(), sum.x());
}

Pose2 BestAlignment(const std::vector<PosePair>& pairs) {
  Eigen::Vector2d reference_centre(0.0, 0.0);
  Eigen::Vector2d estimate_centre(0.0, 0.0);
  for (const PosePair& pair : pairs) {
    reference_centre += pair.reference.translation();
    estimate_centre += pair.estimate.translation();
  }
  reference_centre /= static_cast<double>(pairs.size());
  estimate_centre /= static_cast<double>(pairs.size());
  double dot = 0.0;
  double cross = 0.0;
  for (const PosePair& pair : pairs) {
    const Eigen::Vector2d p = pair.estimate.translation() - estimate_centre;
    const Eigen::Vector2d q = pair.reference.translation() - reference_centre;
    dot += p.dot(q);
    cross += p.x() * q.y() - p.y() * q.x();
  }
  const bool has_direction = std::hypot(dot, cross) > kMinSquaredSpread;
  const double angle = has_direction ? std::atan2(cross, dot) : MeanHeadingDifference(pairs);
  const Eigen::Vector2d shift = reference_centre - Pose2{0.0, 0.0, angle} * estimate_centre;
  return {shift.x(), shift.y(), angle};
}

void RequireMatches(const std::vector<PosePair>& pairs, const Trajectory& reference,
                    const Trajectory& estimate, double max_gap) {
  if (pairs.size() >= 2) return;
  throw std::runtime_error(
      std::to_string(pairs.size()) + " of " + std::to_string(estimate.size()) +
      " poses of the estimate match the reference, two are needed: the reference goes " +
      DescribeSpan(reference) + ", the estimate " + DescribeSpan(estimate) +
      ", gaps of more than " + std::to_string(max_gap) + " s are not interpolated");
}

void SetAbsoluteErrors(const std::vector<PosePair>& pairs, const Pose2& reference_from_estimate,
                       TrajectoryErrors& errors) {
  ErrorList list;
  for (const PosePair& pair : pairs) {
    list.Add(pair.reference.Inverse() * reference_from_estimate * pair.estimate);
  }
  errors.final_position = list.translation.back();
  errors.final_yaw = list.rotation.back();
  errors.position = Summarize(list.translation);
  errors.yaw = Summarize(list.rotation);
}

void AddRelative(const std::string& name, const RelativeErrors& errors, KeyValues& line) {
  line.Add(name + "_rmse_m", errors.translation.rms)
      .Add(name + "_max_m", errors.translation.max)
      .Add(name + "_yaw_rmse_deg", Degrees(errors.rotation.rms))
      .Add(name + "_yaw_max_deg", Degrees(errors.rotation.max))
      .Add(name + "_pairs", errors.translation.count);
}

}  // namespace

void TrajectoryErrorOptions::Validate() const { LookupLimits{max_gap}.Validate(); }

std::vector<PosePair> Associate(const Trajectory& reference, const Trajectory& estimate,
                                double max_gap) {
  const LookupLimits limits{max_gap};
  std::vector<PosePair> pairs;
  for (const StampedPose& pose : estimate) {
    const std::optional<Pose2> reference_pose = PoseAt(reference, pose.stamp, limits);
    if (reference_pose) pairs.push_back({pose.stamp, *reference_pose, pose.pose});
  }
  return pairs;
}

Pose2 Align(const std::vector<PosePair>& pairs, Alignment alignment) {
  switch (alignment) {
    case Alignment::kFirst:
      return pairs.front().reference * pairs.front().estimate.Inverse();
    case Alignment::kBest:
      return BestAlignment(pairs);
    case Alignment::kNone:
      break;
  }
  return {};
}

TrajectoryErrors EvaluateTrajectory(const Trajectory& reference, const Trajectory& estimate,
                                    const TrajectoryErrorOptions& options) {
  options.Validate();
  const std::vector<PosePair> pairs = Associate(reference, estimate, options.max_gap);
  RequireMatches(pairs, reference, estimate, options.max_gap);
  TrajectoryErrors errors;
  errors.poses = estimate.size();
  errors.matched = pairs.size();
  errors.coverage = Seconds(pairs.back().stamp - pairs.front().stamp) /
                    Seconds(reference.back().stamp - reference.front().stamp);
  SetAbsoluteErrors(pairs, Align(pairs, options.alignment), errors);
  const std::vector<double> travelled = Travelled(pairs);
  errors.per_metre = WindowErrors(pairs, travelled, 1.0);
  errors.per_ten_metres = WindowErrors(pairs, travelled, 10.0);
  errors.per_second = WindowErrors(pairs, Elapsed(pairs), 1.0);
  errors.path = travelled.back();
  errors.drift = RelativeError(pairs.front(), pairs.back()).translation().norm() / errors.path;
  return errors;
}

std::string ToKeyValues(const TrajectoryErrors& errors) {
  KeyValues line;
  line.Add("poses", errors.poses)
      .Add("matched", errors.matched)
      .Add("coverage_percent", 100.0 * errors.coverage)
      .Add("ate_rmse_m", errors.position.rms)
      .Add("ate_mean_m", errors.position.mean)
      .Add("ate_median_m", errors.position.median)
      .Add("ate_max_m", errors.position.max)
      .Add("ate_final_m", errors.final_position)
      .Add("yaw_rmse_deg", Degrees(errors.yaw.rms))
      .Add("yaw_mean_deg", Degrees(errors.yaw.mean))
      .Add("yaw_median_deg", Degrees(errors.yaw.median))
      .Add("yaw_max_deg", Degrees(errors.yaw.max))
      .Add("yaw_final_deg", Degrees(errors.final_yaw));
  AddRelative("rpe_1m", errors.per_metre, line);
  AddRelative("rpe_10m", errors.per_ten_metres, line);
  AddRelative("rpe_1s", errors.per_second, line);
  line.Add("path_m", errors.path).Add("drift_percent", 100.0 * errors.drift);
  return line.Line();
}

}  // namespace scan_image_slam
