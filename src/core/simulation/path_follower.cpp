#include "scan_image_slam/core/simulation/path_follower.h"

#include <algorithm>
#include <cmath>

namespace scan_image_slam {
namespace {

constexpr double kLookAhead = 0.25;        // [m]
constexpr double kLookAheadTime = 0.35;    // more of it when driving fast [s]
constexpr double kHeadingReached = 0.003;  // [rad]
constexpr double kTurnBraking = 0.35;      // [rad/s^2]
constexpr double kCreep = 0.03;            // slowest speed while driving [m/s]
constexpr double kStandstill = 0.01;       // [m/s] and [rad/s]

}  // namespace

PathFollower::PathFollower(const RobotPath& path) : path_(path), legs_(MakeLegs(path)) {}

double PathFollower::share() const {
  std::size_t all = 0;
  std::size_t driven = progress_;
  for (std::size_t i = 0; i < legs_.size(); ++i) {
    all += legs_[i].points.size();
    if (i < leg_) driven += legs_[i].points.size();
  }
  return done() || all == 0 ? 1.0 : static_cast<double>(driven) / static_cast<double>(all);
}

Velocity PathFollower::Command(const TrueState& state) {
  if (done()) return {};
  const PathLeg& leg = legs_[leg_];
  return turned_ ? Follow(state, leg) : Turn(state, leg);
}

Velocity PathFollower::Turn(const TrueState& state, const PathLeg& leg) {
  const double error = NormalizeAngle(leg.start_heading - state.world_from_base.theta);
  if (std::abs(error) < kHeadingReached && std::abs(state.turn_rate) < kStandstill) {
    turned_ = true;
    return {};
  }
  const double rate = std::min(path_.turn_rate, std::sqrt(2.0 * kTurnBraking * std::abs(error)));
  return {0.0, std::copysign(rate, error)};
}

Velocity PathFollower::Follow(const TrueState& state, const PathLeg& leg) {
  const Eigen::Vector2d position = state.world_from_base.translation();
  const auto distance = [&](std::size_t i) { return (leg.points[i] - position).squaredNorm(); };
  while (progress_ + 1 < leg.points.size() && distance(progress_ + 1) <= distance(progress_)) {
    ++progress_;
  }
  const double remaining = (leg.points.back() - position).dot(leg.end_direction);
  if (progress_ + 1 == leg.points.size() && remaining <= 0.0) {
    if (std::abs(state.speed) < kStandstill) {
      ++leg_;
      progress_ = 0;
      turned_ = false;
    }
    return {};
  }
  // The path goes straight on beyond its end, so that there is always a point to look at.
  const auto ahead =
      static_cast<std::size_t>((kLookAhead + kLookAheadTime * state.speed) / PathLeg::kStep);
  Eigen::Vector2d target;
  if (progress_ + ahead < leg.points.size()) {
    target = leg.points[progress_ + ahead];
  } else {
    const std::size_t beyond = progress_ + ahead + 1 - leg.points.size();
    target = leg.points.back() + static_cast<double>(beyond) * PathLeg::kStep * leg.end_direction;
  }
  const Eigen::Vector2d local = state.world_from_base.Inverse() * target;
  const double curvature = 2.0 * local.y() / local.squaredNorm();
  // Slower where the robot could not turn fast enough, e.g. to come back to the path.
  const double limit = path_.turn_rate / std::max(std::abs(curvature), 1e-9);
  const double speed = std::max(std::min(leg.speeds[progress_], limit), kCreep);
  return {speed, std::clamp(speed * curvature, -path_.turn_rate, path_.turn_rate)};
}

}  // namespace scan_image_slam
