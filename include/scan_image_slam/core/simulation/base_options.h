#pragma once

namespace scan_image_slam {

/// A differential drive and its encoders; the defaults are like the Tetra-DS III.
struct BaseSimulatorOptions {
  double wheel_base = 0.438;        ///< between the wheels [m]
  double max_speed = 0.6;           ///< [m/s]
  double max_turn_rate = 0.139626;  ///< [rad/s], 8 deg/s
  double acceleration = 0.5;        ///< [m/s^2]
  double turn_acceleration = 1.5;   ///< [rad/s^2]
  double wander = 0.003;            ///< standard deviation of the unwanted turn rate [rad/s]

  /// Encoders: what they report is wrong by these.
  double left_radius_error = 0.012;   ///< distance too long, fraction
  double right_radius_error = 0.014;  ///< distance too long, fraction
  double wheel_base_error = -0.01;    ///< assumed wheel base too long, fraction
  double slip_noise = 0.002;          ///< of each wheel [m per square root of a metre]
  double slip_rate = 0.05;            ///< slips begun per metre driven [1/m]
  double slip_duration = 0.3;         ///< mean [s]
  double slip_speed = 0.15;           ///< false speed of a wheel while slipping, at most [m/s]
  double position_quantum = 0.001;    ///< 0 none [m]
  double heading_quantum = 0.0017453292519943296;  ///< 0 none [rad], 0.1 deg

  double odometry_rate = 30.0;      ///< [Hz]
  double odometry_phase = 0.005;    ///< of the first reading [s]
  double odometry_delay = 0.008;    ///< from reading the encoders to the stamp [s]
  double odometry_latency = 0.001;  ///< from the stamp to the arrival [s]
  double odometry_jitter = 0.001;   ///< mean of an exponential delay of the reading [s]

  /// Throws std::invalid_argument, naming the field, if a value is out of range.
  void Validate() const;
};

/// The same base that drives exactly; with `ideal_encoders` they report exactly, too, else they
/// keep their errors of radius and wheel base and only do not slip or round.
BaseSimulatorOptions Ideal(BaseSimulatorOptions options, bool ideal_encoders);

}  // namespace scan_image_slam
