#pragma once

#include "scan_image_slam/core/simulation/mount_pose.h"

namespace scan_image_slam {

/// What a laser reports where nothing came back.
enum class NoReturn { kNan, kInfinity, kOneMillimetre, kZero };

/// A scanning laser; the defaults are the UTM-30LX-EW.
struct LaserSimulatorOptions {
  MountPose mount{0.15, 0.0, 0.30, 0.0, 0.0, 0.0};  ///< pitch and roll must be 0
  bool upside_down = false;  ///< hangs with its scan running clockwise seen from above

  int beams = 1081;
  double angle_min = -2.356194490192345;          ///< first beam [rad]
  double angle_increment = 0.004363323129985824;  ///< [rad]
  double rate = 40.0;                             ///< turns per second [Hz]
  double steps_per_turn = 1440.0;  ///< beams in a full turn: time_increment = 1 / rate / steps
  double range_min = 0.1;          ///< [m]
  double range_max = 30.0;         ///< [m]
  double beam_width = 0.004;       ///< of the light spot, full angle [rad]

  double range_stddev = 0.010;       ///< up to 10 m [m]
  double far_range_stddev = 0.017;   ///< from 20 m on, between them growing [m]
  double grazing_noise = 0.05;       ///< noise as a fraction of the spot's length along the ray
  double incidence_bias = 0.004;     ///< added where the wall is almost parallel to the ray [m]
  double dark_bias = 0.010;          ///< added on dark walls [m]
  double quantum = 0.001;            ///< resolution of a range, 0 none [m]
  bool mixed_pixels = true;          ///< ranges between two surfaces if the spot hits both
  double mixed_depth = 0.8;          ///< surfaces farther apart are told apart [m]
  double drop_rate = 0.0005;         ///< probability of no return from anything
  double grazing_drop_angle = 1.45;  ///< incidence from which returns get lost [rad]
  double dark_range = 12.0;          ///< farthest return from a dark wall [m]
  double glass_angle = 0.12;         ///< incidence up to which glass returns [rad]
  NoReturn no_return = NoReturn::kNan;

  double stamp_offset = 0.0;      ///< clock of the laser minus that of the robot [s]
  double stamp_jitter = 0.0001;   ///< standard deviation of the stamps [s]
  double rate_error = 0.0;        ///< fraction by which the laser turns too fast
  double phase = 0.0;             ///< of the first scan [s]
  double latency = 0.004;         ///< from the last beam to the arrival [s]
  double latency_jitter = 0.001;  ///< mean of an exponential delay on top [s]

  double TimeIncrement() const;  ///< between two beams [s]
  double Period() const;         ///< between two scans [s]
  /// Throws std::invalid_argument, naming the field, if a value is out of range.
  void Validate() const;
};

/// The same laser without noise, bias, rounding, mixed pixels and losses.
LaserSimulatorOptions Ideal(LaserSimulatorOptions options);

}  // namespace scan_image_slam
