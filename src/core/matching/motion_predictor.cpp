#include "scan_image_slam/core/matching/motion_predictor.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace scan_image_slam {
namespace {

Eigen::Matrix3d CovarianceOf(const Pose2& motion, double dt, const MotionNoise& noise) {
  const double distance = motion.translation().norm();
  const double angle = std::abs(motion.theta);
  const double forward =
      noise.min_distance + noise.distance_per_distance * distance + noise.distance_per_time * dt;
  const double left = noise.lateral_fraction * forward;
  const double turn = noise.min_angle + noise.angle_per_angle * angle +
                      noise.angle_per_distance * distance + noise.angle_per_time * dt;
  return Eigen::Vector3d(forward * forward, left * left, turn * turn).asDiagonal();
}

/// Without encoders the bounds are all that is known: a third of the window is one deviation.
Eigen::Matrix3d CovarianceOf(const SearchWindow& window) {
  const Eigen::Vector3d stddev =
      Eigen::Vector3d(window.half_distance, window.half_lateral, window.half_angle) / 3.0;
  return stddev.cwiseAbs2().asDiagonal();
}

/// Encoders that were reset or hit can jump by more than any error of theirs; a robot can't. Then
/// the window reaches what inertia alone predicts.
SearchWindow IncludingJump(const Pose2& kept_motion, const Pose2& predicted_motion,
                           SearchWindow window, const MotionBounds& bounds) {
  constexpr double kJumpDistance = 0.5;  // [m]
  constexpr double kJumpAngle = 0.5;     // [rad]
  const Pose2 jump = predicted_motion.Inverse() * kept_motion;
  const double distance = jump.translation().norm();
  const double angle = std::abs(jump.theta);
  if (distance < kJumpDistance && angle < kJumpAngle) return window;
  window.half_angle = std::max(window.half_angle, std::min(M_PI, angle + bounds.min_angle));
  window.half_distance = std::max(window.half_distance, distance + bounds.min_distance);
  window.half_lateral =
      std::max(window.half_lateral, bounds.lateral_per_distance * window.half_distance);
  return window;
}

}  // namespace

void MotionNoise::Validate() const {
  const auto require = [](double value, const char* name) {
    if (!(std::isfinite(value) && value >= 0.0)) {
      throw std::invalid_argument(std::string(name) + " must be finite and not negative");
    }
  };
  require(distance_per_distance, "distance_per_distance");
  require(distance_per_time, "distance_per_time");
  require(min_distance, "min_distance");
  require(lateral_fraction, "lateral_fraction");
  require(angle_per_angle, "angle_per_angle");
  require(angle_per_distance, "angle_per_distance");
  require(angle_per_time, "angle_per_time");
  require(min_angle, "min_angle");
}

void MotionPredictorOptions::Validate() const {
  odometry.Validate();
  bounds.Validate();
  noise.Validate();
  const double lateral = lateral_per_distance_without_encoders;
  if (!(std::isfinite(lateral) && lateral >= 0.0)) {
    throw std::invalid_argument(
        "lateral_per_distance_without_encoders must be finite and not negative");
  }
}

MotionPredictor::MotionPredictor(const MotionPredictorOptions& options)
    : options_(options), odometry_(options.odometry) {
  options_.Validate();
}

MotionPrediction MotionPredictor::Predict(Stamp stamp) const {
  MotionPrediction prediction;
  prediction.odom_from_base = odometry_.OdomFromBase(stamp);
  if (!last_stamp_) return prediction;

  const double dt = Seconds(stamp - *last_stamp_);
  prediction.dt = std::max(dt, period_);  // stamps may jitter
  const std::optional<Pose2> continuous_from_base = odometry_.ContinuousPose(stamp);
  // Encoders that had not reached the last scan may have done so by now.
  const std::optional<Pose2> last_continuous_from_base =
      !last_continuous_from_base_ && odometry_.Surrounds(*last_stamp_)
          ? odometry_.ContinuousPose(*last_stamp_)
          : last_continuous_from_base_;
  MotionBounds bounds = options_.bounds;
  if (continuous_from_base && last_continuous_from_base) {
    prediction.from_encoders = true;
    prediction.motion = last_continuous_from_base->Inverse() * *continuous_from_base;
  } else {
    prediction.motion = Move(velocity_, std::min(dt, bounds.max_time));
    bounds.lateral_per_distance = options_.lateral_per_distance_without_encoders;
    constexpr double kGap = 3.0;  // usual periods
    prediction.blind = !odometry_.empty() && dt > std::max(bounds.max_time, kGap * period_);
    // Though readings were lost around the last scan, those before and after tell most of the way.
    if (prediction.blind && continuous_from_base) {
      const std::optional<Pose2> roughly_last = odometry_.ContinuousPose(*last_stamp_);
      if (roughly_last) prediction.motion = roughly_last->Inverse() * *continuous_from_base;
    }
  }
  prediction.window = MakeWindow(prediction.motion, prediction.dt, bounds);
  if (prediction.from_encoders) {
    prediction.window = IncludingJump(Move(velocity_, std::min(dt, bounds.max_time)),
                                      prediction.motion, prediction.window, bounds);
  }
  prediction.covariance =
      prediction.from_encoders
          ? CovarianceOf(prediction.motion, std::min(prediction.dt, bounds.max_time),
                         options_.noise)
          : CovarianceOf(prediction.window);
  return prediction;
}

void MotionPredictor::Update(Stamp stamp, const Pose2& matched_motion) {
  if (last_stamp_) {
    constexpr double kAdaption = 0.02;
    const double dt = Seconds(stamp - *last_stamp_);
    velocity_ = VelocityOf(matched_motion, std::max(dt, period_));  // stamps may jitter
    period_ = period_ == 0.0 ? dt : period_ + kAdaption * (std::min(dt, 3.0 * period_) - period_);
  }
  last_stamp_ = stamp;
  last_continuous_from_base_ = odometry_.ContinuousPose(stamp);
}

}  // namespace scan_image_slam
