#include "scan_image_slam/core/sensor/odometry_buffer.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace scan_image_slam {
namespace {

void RequirePositive(double value, const char* name) {
  if (!(std::isfinite(value) && value > 0.0)) {
    throw std::invalid_argument(std::string(name) + " must be positive and finite");
  }
}

}  // namespace

void OdometryOptions::Validate() const {
  RequirePositive(max_speed, "max_speed");
  RequirePositive(max_turn_rate, "max_turn_rate");
  RequirePositive(max_extrapolation, "max_extrapolation");
  RequirePositive(history, "history");
}

OdometryBuffer::OdometryBuffer(const OdometryOptions& options) : options_(options) {
  options_.Validate();
}

OdometryBuffer::Result OdometryBuffer::Add(Stamp stamp, const Pose2& odom_from_base) {
  if (readings_.empty()) {
    readings_.push_back({stamp, odom_from_base});
    last_odom_from_base_ = odom_from_base;
    odom_from_continuous_ = Pose2{};
    return Result::kAdded;
  }
  const Reading& last = readings_.back();
  if (stamp <= last.stamp) return AddStale(stamp, odom_from_base);
  stale_ = 0;

  // Positions are only trusted to the encoders' resolution, so a short step may look fast.
  constexpr double kPositionSlack = 0.05;
  constexpr double kAngleSlack = 0.05;
  // Stamps may jitter, so a step is judged by the usual period if that is longer.
  const double dt = Seconds(stamp - last.stamp);
  const double step = std::max(dt, period_);
  Pose2 motion = last_odom_from_base_.Inverse() * odom_from_base;
  const bool reset = motion.translation().norm() > options_.max_speed * step + kPositionSlack ||
                     std::abs(motion.theta) > options_.max_turn_rate * step + kAngleSlack;
  if (reset) motion = Move(NewestVelocity(), std::min(dt, options_.max_extrapolation));
  const Pose2 continuous_from_base = last.continuous_from_base * motion;
  if (reset) odom_from_continuous_ = odom_from_base * continuous_from_base.Inverse();
  readings_.push_back({stamp, continuous_from_base});
  period_ = period_ == 0.0 ? dt : period_ + 0.05 * (std::min(dt, 10.0 * period_) - period_);
  last_odom_from_base_ = odom_from_base;
  while (readings_.size() > 2 && Seconds(stamp - readings_.front().stamp) > options_.history) {
    readings_.pop_front();
  }
  return reset ? Result::kReset : Result::kAdded;
}

/// A few that come late are nothing; if time goes on without ever reaching the newest reading, then
/// that one was stamped in the future, or the clock has been set back.
OdometryBuffer::Result OdometryBuffer::AddStale(Stamp stamp, const Pose2& odom_from_base) {
  constexpr int kPatience = 20;  // readings in a row, each later than the one before
  if (stamp == readings_.back().stamp) return Result::kStale;  // told twice
  stale_ = stale_ == 0 || stamp > last_stale_ ? stale_ + 1 : 1;
  last_stale_ = stamp;
  if (stale_ < kPatience) return Result::kStale;
  const Pose2 continuous_from_base = readings_.back().continuous_from_base;
  Clear();
  readings_.push_back({stamp, continuous_from_base});
  odom_from_continuous_ = odom_from_base * continuous_from_base.Inverse();
  last_odom_from_base_ = odom_from_base;
  return Result::kReset;
}

std::deque<OdometryBuffer::Reading>::const_iterator OdometryBuffer::After(Stamp stamp) const {
  return std::upper_bound(readings_.begin(), readings_.end(), stamp,
                          [](Stamp s, const Reading& reading) { return s < reading.stamp; });
}

bool OdometryBuffer::Surrounds(Stamp stamp) const {
  const auto after = After(stamp);
  if (after == readings_.begin() || after == readings_.end()) return false;
  return Seconds(after->stamp - (after - 1)->stamp) <= options_.max_extrapolation;
}

std::optional<Pose2> OdometryBuffer::ContinuousPose(Stamp stamp) const {
  if (readings_.empty()) return std::nullopt;
  if (stamp < readings_.front().stamp) {
    const double early = Seconds(readings_.front().stamp - stamp);
    if (early > options_.max_extrapolation) return std::nullopt;
    return readings_.front().continuous_from_base;
  }
  const Reading& newest = readings_.back();
  if (stamp >= newest.stamp) {
    const double ahead = Seconds(stamp - newest.stamp);
    if (ahead > options_.max_extrapolation) return std::nullopt;
    return newest.continuous_from_base * Move(NewestVelocity(), ahead);
  }
  const auto after = After(stamp);
  const auto before = after - 1;
  return Interpolate(before->continuous_from_base, after->continuous_from_base,
                     Seconds(stamp - before->stamp) / Seconds(after->stamp - before->stamp));
}

std::optional<Pose2> OdometryBuffer::OdomFromBase(Stamp stamp) const {
  const std::optional<Pose2> pose = ContinuousPose(stamp);
  if (!pose) return std::nullopt;
  return odom_from_continuous_ * *pose;
}

Velocity2 OdometryBuffer::NewestVelocity() const {
  // Over less time the resolution of the encoders would tell more than the motion does.
  constexpr double kSpan = 0.1;  // [s]
  if (readings_.size() < 2) return Velocity2{};
  const Reading& newest = readings_.back();
  auto before = readings_.end() - 2;
  while (before != readings_.begin() && Seconds(newest.stamp - before->stamp) < kSpan) {
    const auto earlier = before - 1;
    if (Seconds(before->stamp - earlier->stamp) > options_.max_extrapolation) break;  // a pause
    before = earlier;
  }
  // Readings that were delayed on their way come close together.
  const double span = std::max(Seconds(newest.stamp - before->stamp), period_);
  return VelocityOf(before->continuous_from_base.Inverse() * newest.continuous_from_base, span);
}

void OdometryBuffer::Clear() {
  readings_.clear();
  period_ = 0.0;
  stale_ = 0;
}

}  // namespace scan_image_slam
