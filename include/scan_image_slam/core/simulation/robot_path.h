#pragma once

#include "scan_image_slam/core/geometry/pose2.h"

#include <string>
#include <vector>

#include <Eigen/Core>

namespace scan_image_slam {

/// Where a robot shall drive. Corners are rounded; where the way turns by more than 135 degrees, or
/// the radius is 0, the robot stops and turns on the spot.
struct RobotPath {
  std::string name = "default";
  Pose2 start;                              ///< world_from_base in the beginning
  std::vector<Eigen::Vector2d> way_points;  ///< after the start, world frame [m]
  double speed = 0.6;                       ///< at most [m/s]
  double turn_rate = 0.139626;              ///< at most [rad/s]
  double acceleration = 0.3;                ///< [m/s^2]
  double corner_radius = 1.0;               ///< [m]
  double start_pause = 1.0;                 ///< stands still before driving [s]
  double end_pause = 1.0;                   ///< and after it [s]
};

/// A stretch that is driven without stopping, sampled evenly.
struct PathLeg {
  static constexpr double kStep = 0.02;  ///< between two samples [m]
  double start_heading = 0.0;            ///< to be turned to before driving off [rad]
  std::vector<Eigen::Vector2d> points;   ///< [m]
  std::vector<double> speeds;            ///< limit at each point, 0 at the end [m/s]
  Eigen::Vector2d end_direction{1, 0};   ///< unit vector
};

/// The legs that a path stands for. Throws std::invalid_argument if two way points coincide.
std::vector<PathLeg> MakeLegs(const RobotPath& path);

}  // namespace scan_image_slam
