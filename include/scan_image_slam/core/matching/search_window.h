#pragma once

#include "scan_image_slam/core/geometry/pose2.h"

namespace scan_image_slam {

/// How far the true motion can be from the predicted one: what makes D and Phi of the paper.
struct MotionBounds {
  double distance_per_distance = 0.1;  ///< wheel radius and slip along the way [m/m]
  double distance_per_angle = 0.02;    ///< slip while turning [m/rad]
  double distance_per_time = 1.0;      ///< wheels that spin or block [m/s]
  double min_distance = 0.005;         ///< floor of D [m]
  double angle_per_angle = 0.3;        ///< wheel base and slip [rad/rad]
  double angle_per_distance = 0.05;    ///< unequal wheels [rad/m]
  double angle_per_time = 3.0;         ///< wheels that spin or block [rad/s]
  double min_angle = 0.005;            ///< floor of Phi [rad]
  double lateral_per_distance = 0.5;   ///< sideways bound as a fraction of D; 0: a pure arc [-]
  double max_time = 0.5;               ///< longer gaps do not widen the window further [s]
  /// Throws std::invalid_argument, naming the field, if a value is negative or not finite.
  void Validate() const;
};

/// Closed, symmetric box around the predicted motion.
struct SearchWindow {
  double half_distance = 0.0;  ///< D [m]
  double half_lateral = 0.0;   ///< sideways: what the arc of a differential drive leaves out [m]
  double half_angle = 0.0;     ///< Phi [rad], at most pi

  /// True if the deviation from the prediction lies inside; borders included.
  bool Contains(const ArcCoordinates& deviation) const;
  /// The nearest deviation that lies inside.
  ArcCoordinates Clamp(const ArcCoordinates& deviation) const;
};

/// Steps 1 and 2 of the paper: how far off a predicted `motion` over `dt` seconds can be.
SearchWindow MakeWindow(const Pose2& motion, double dt, const MotionBounds& bounds);

}  // namespace scan_image_slam
