#pragma once

#include "scan_image_slam/core/simulation/base_options.h"
#include "scan_image_slam/core/simulation/motion_history.h"
#include "scan_image_slam/core/simulation/random_stream.h"

#include <cstdint>

namespace scan_image_slam {

/// The base's dead reckoning as it is published.
struct OdometryReading {
  Stamp stamp = 0;         ///< of the publication, which is later than the reading [ns]
  Stamp arrival = 0;       ///< when the computer gets it [ns]
  Pose2 odom_from_base;    ///< starts at zero
  double speed = 0.0;      ///< ahead [m/s]
  double turn_rate = 0.0;  ///< [rad/s]
};

/// Wheel encoders with wrong radii, a wrong wheel base and slip, and the odometry made from them.
class EncoderSimulator {
 public:
  EncoderSimulator(const BaseSimulatorOptions& options, std::uint64_t seed, Stamp start);

  /// Counts the motion from the last state to this one.
  void Follow(const TrueState& state);

  /// Turns the odometry by `angle` [rad] that the robot has not turned.
  void AddFalseTurn(double angle) { odom_from_base_.theta += angle; }

  /// Puts the odometry back to zero.
  void Reset() { odom_from_base_ = Pose2{}; }

  /// When the encoders are read next [ns].
  Stamp NextReading() const { return next_reading_; }

  /// What is published about the last state that was followed; Follow(NextReading()) comes first.
  OdometryReading Read();

 private:
  void UpdateSlip(double distance, double dt);
  double WheelReport(double distance, double radius_error, double false_speed, double dt);
  void ScheduleNext();

  BaseSimulatorOptions options_;
  RandomStream slip_;
  RandomStream timing_;
  Stamp start_;
  Stamp time_;
  std::int64_t count_ = 0;
  Stamp next_reading_ = 0;
  Pose2 odom_from_base_;
  Pose2 last_reading_;
  Stamp last_reading_time_;
  Stamp last_arrival_;
  double slip_left_ = 0.0;   // remaining time [s]
  double false_left_ = 0.0;  // speed [m/s]
  double false_right_ = 0.0;
};

}  // namespace scan_image_slam
