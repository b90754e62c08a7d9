#include "scan_image_slam/core/simulation/drive_simulator.h"

#include <algorithm>
#include <cmath>

namespace scan_image_slam {
namespace {

constexpr double kWanderTime = 1.0;  // over which the floor's influence changes [s]

double Approach(double now, double wanted, double limit, double most_change) {
  const double target = std::clamp(wanted, -limit, limit);
  return now + std::clamp(target - now, -most_change, most_change);
}

}  // namespace

DriveSimulator::DriveSimulator(const BaseSimulatorOptions& options, const TrueState& start,
                               std::uint64_t seed)
    : options_(options), random_(seed, "drive"), state_(start) {
  options_.Validate();
}

void DriveSimulator::StepTo(Stamp time, const Velocity& command) {
  const double dt = Seconds(time - state_.time);
  if (dt <= 0.0) return;
  state_.speed =
      Approach(state_.speed, command.speed, options_.max_speed, options_.acceleration * dt);
  turn_rate_ = Approach(turn_rate_, command.turn_rate, options_.max_turn_rate,
                        options_.turn_acceleration * dt);
  // Ornstein-Uhlenbeck: the same spread at all times, forgotten after a second.
  wander_ += -wander_ * dt / kWanderTime +
             options_.wander * std::sqrt(2.0 * dt / kWanderTime) * random_.Normal();
  const double rolling = std::min(std::abs(state_.speed) / options_.max_speed, 1.0);
  state_.turn_rate =
      std::clamp(turn_rate_ + rolling * wander_, -options_.max_turn_rate, options_.max_turn_rate);
  state_.world_from_base = state_.world_from_base * Arc(state_.speed * dt, state_.turn_rate * dt);
  state_.time = time;
}

}  // namespace scan_image_slam
