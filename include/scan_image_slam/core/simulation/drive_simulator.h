#pragma once

#include "scan_image_slam/core/simulation/base_options.h"
#include "scan_image_slam/core/simulation/motion_history.h"
#include "scan_image_slam/core/simulation/random_stream.h"

#include <cstdint>

namespace scan_image_slam {

/// What a differential drive is told to do.
struct Velocity {
  double speed = 0.0;      ///< ahead [m/s]
  double turn_rate = 0.0;  ///< to the left [rad/s]
};

/// The robot's true motion: commands within the limits of speed and acceleration, on a floor that
/// turns it a little.
class DriveSimulator {
 public:
  DriveSimulator(const BaseSimulatorOptions& options, const TrueState& start, std::uint64_t seed);

  /// Moves on to `time` (at most some milliseconds later) under a command.
  void StepTo(Stamp time, const Velocity& command);

  const TrueState& state() const { return state_; }

 private:
  BaseSimulatorOptions options_;
  RandomStream random_;
  TrueState state_;
  double turn_rate_ = 0.0;  // without wander
  double wander_ = 0.0;
};

}  // namespace scan_image_slam
