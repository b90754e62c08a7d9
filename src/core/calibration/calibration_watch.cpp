#include "scan_image_slam/core/calibration/calibration_watch.h"

#include "scan_image_slam/core/calibration/upright_edges.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Dense>

namespace scan_image_slam {
namespace {

using Pair = CalibrationWatch::Pair;
using Pairs = std::vector<Pair>;

constexpr std::size_t kMinPairs = 200;   // of an answer
constexpr std::size_t kMaxPairs = 2000;  // kept, if they are of so many views
constexpr int kMinViews = 100;           // of an answer: one view is much like the next
constexpr double kMinDistance = 0.1;     // between two views [m]
constexpr double kMinAngle = 0.03;       // or turned [rad]
constexpr double kSpan = 0.05;           // of a velocity, before and after the picture [s]

constexpr double kGate = 0.07;       // farther apart is no pair [rad]
constexpr double kYawStep = 0.002;   // of the vote [rad]
constexpr int kYawSteps = 35;        // to either side, up to the gate
constexpr double kTimeStep = 0.005;  // of the vote [s]
constexpr int kTimeSteps = 20;       // to either side

constexpr double kYawStddev = 1.0;   // of what is known before [rad]
constexpr double kTimeStddev = 0.1;  // [s]

/// A correction of the camera, and how certain it is: yaw [rad] and time [s].
struct ShiftFit {
  Eigen::Vector2d correction{0, 0};
  Eigen::Vector2d stddev{0, 0};
};

/// The yaw and the time for which most edges lie on discontinuities; of times alike, the least.
ShiftFit Vote(const Pairs& pairs) {
  ShiftFit best;
  double most = 0.0;
  for (int n = 0; n <= 2 * kTimeSteps; ++n) {
    const int step = n % 2 == 0 ? n / 2 : -(n + 1) / 2;
    const double time = step * kTimeStep;
    std::vector<double> votes(2 * kYawSteps + 1, 0.0);
    for (const Pair& pair : pairs) {
      const double yaw = -(pair.residual + pair.by_time * time);
      const int bin = kYawSteps + static_cast<int>(std::lround(yaw / kYawStep));
      if (bin >= 0 && bin < static_cast<int>(votes.size())) votes[bin] += 1.0;
    }
    for (int i = 1; i < 2 * kYawSteps; ++i) {
      const double sum = votes[i - 1] + 2.0 * votes[i] + votes[i + 1];
      if (sum <= most) continue;
      most = sum;
      best.correction = {(i - kYawSteps) * kYawStep, time};
    }
  }
  return best;
}

/// Least squares with Tukey's weights: pairs that do not belong together have none.
ShiftFit Refine(ShiftFit fit, const Pairs& pairs) {
  constexpr int kIterations = 10;
  constexpr double kFar = 4.0;  // of no weight [standard deviations]
  const Eigen::Vector2d known(kYawStddev, kTimeStddev);
  for (int n = 0; n < kIterations; ++n) {
    Eigen::Matrix2d information = known.cwiseAbs2().cwiseInverse().asDiagonal();
    Eigen::Vector2d gradient = information * fit.correction;
    for (const Pair& pair : pairs) {
      const Eigen::Vector2d jacobian = Eigen::Vector2d(1.0, pair.by_time) / pair.stddev;
      const double residual = pair.residual / pair.stddev + jacobian.dot(fit.correction);
      const double share = std::min(1.0, std::abs(residual) / kFar);
      const double weight = (1.0 - share * share) * (1.0 - share * share);
      information += weight * jacobian * jacobian.transpose();
      gradient += weight * residual * jacobian;
    }
    const Eigen::Matrix2d covariance = information.inverse();
    fit.correction -= covariance * gradient;
    fit.stddev = covariance.diagonal().cwiseSqrt();
  }
  return fit;
}

ShiftFit FitTo(const Pairs& pairs) { return Refine(Vote(pairs), pairs); }

}  // namespace

void CalibrationWatch::Add(const ScanImageFusion& fusion, const FusedModel& model) {
  if (!model.has_image) return;
  const FusionEvidence& evidence = fusion.evidence();
  const OdometryBuffer& odometry = fusion.odometry();
  const Stamp taken = evidence.image.stamp;
  const std::optional<Pose2> now = odometry.ContinuousPose(taken);
  const std::optional<Pose2> before = odometry.ContinuousPose(taken - FromSeconds(kSpan));
  const std::optional<Pose2> after = odometry.ContinuousPose(taken + FromSeconds(kSpan));
  if (!now || !before || !after || !HasMoved(*now)) return;
  last_ = *now;
  ++view_;
  JumpSight sight;
  sight.velocity = VelocityOf(before->Inverse() * *after, 2.0 * kSpan);
  for (const RangeJump& jump : FindRangeJumps(model, RangeJumpOptions())) {
    const Stamp fired = model.stamp + FromSeconds(jump.time_offset);
    const std::optional<Pose2> then = odometry.ContinuousPose(fired);
    if (!then) continue;
    const Eigen::Vector2d ray(std::cos(jump.heading), std::sin(jump.heading));
    const Eigen::Vector2d in_base = model.base_from_laser.translation() + jump.range * ray;
    sight.point = now->Inverse() * *then * in_base;
    sight.bearing_stddev = jump.stddev;
    AddPairs(sight, evidence, *fusion.bearing_image());
  }
  while (pairs_.size() > kMaxPairs && Views() > kMinViews) pairs_.pop_front();
}

/// From the first to the last pair.
int CalibrationWatch::Views() const {
  return pairs_.empty() ? 0 : pairs_.back().view - pairs_.front().view + 1;
}

bool CalibrationWatch::HasMoved(const Pose2& odom_from_base) const {
  const Pose2 motion = last_.Inverse() * odom_from_base;
  return motion.translation().norm() >= kMinDistance || std::abs(motion.theta) >= kMinAngle;
}

void CalibrationWatch::AddPairs(const JumpSight& sight, const FusionEvidence& evidence,
                                const BearingImage& image) {
  constexpr double kMoment = 1e-3;  // [s]
  CalibrationVector none{};
  CalibrationVector later{};
  later[kTime] = kMoment;
  const Eigen::Vector2d camera = image.centre().head<2>();
  for (const ImageEdge& edge : evidence.edges) {
    ViewedEdge viewed;
    viewed.bearing = image.Bearing(edge.column);
    Pair pair;
    pair.residual = BearingResidual(sight, viewed, camera, none.data());
    if (std::abs(pair.residual) > kGate) continue;
    const double moved = BearingResidual(sight, viewed, camera, later.data());
    pair.by_time = (moved - pair.residual) / kMoment;
    pair.stddev = std::hypot(sight.bearing_stddev, kEdgeStddev * image.step());
    pair.view = view_;
    pairs_.push_back(pair);
  }
}

std::optional<CameraMisfit> CalibrationWatch::Misfit() const {
  // What is alike by chance is another yaw in each half.
  constexpr double kYawTolerance = 0.0035;  // [rad]
  constexpr double kTimeTolerance = 0.01;   // [s]
  constexpr double kCertain = 3.0;          // standard deviations
  if (pairs_.size() < kMinPairs || Views() < kMinViews) return std::nullopt;
  const auto middle = pairs_.begin() + static_cast<long>(pairs_.size() / 2);
  const ShiftFit older = FitTo(Pairs(pairs_.begin(), middle));
  const ShiftFit newer = FitTo(Pairs(middle, pairs_.end()));
  const Eigen::Vector2d apart = (older.correction - newer.correction).cwiseAbs();
  const Eigen::Vector2d doubt = kCertain * (older.stddev + newer.stddev);
  if (apart[0] > kYawTolerance + doubt[0] || apart[1] > kTimeTolerance + doubt[1]) {
    return std::nullopt;
  }
  const ShiftFit all = Refine(newer, Pairs(pairs_.begin(), pairs_.end()));
  return CameraMisfit{all.correction[0], std::max(all.stddev[0], 0.5 * apart[0]), all.correction[1],
                      std::max(all.stddev[1], 0.5 * apart[1])};
}

}  // namespace scan_image_slam
