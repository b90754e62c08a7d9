#pragma once

#include "scan_image_slam/core/geometry/pose2.h"

#include <Eigen/Geometry>

namespace scan_image_slam {

/// Where a sensor sits on the robot: base_from_sensor, angles as in URDF (roll about x, then pitch
/// about y, then yaw about z, all axes of the base; x ahead, y left, z up).
struct MountPose {
  double x = 0.0;      ///< [m]
  double y = 0.0;      ///< [m]
  double z = 0.0;      ///< above the floor [m]
  double yaw = 0.0;    ///< to the left [rad]
  double pitch = 0.0;  ///< down [rad]
  double roll = 0.0;   ///< right side down [rad]

  /// The part in the plane: base_from_sensor without height and tilt.
  Pose2 Planar() const { return {x, y, yaw}; }

  Eigen::Quaterniond Rotation() const {
    using Eigen::AngleAxisd;
    using Eigen::Vector3d;
    return AngleAxisd(yaw, Vector3d::UnitZ()) * AngleAxisd(pitch, Vector3d::UnitY()) *
           AngleAxisd(roll, Vector3d::UnitX());
  }

  Eigen::Isometry3d Transform() const {
    Eigen::Isometry3d base_from_sensor = Eigen::Isometry3d::Identity();
    base_from_sensor.translate(Eigen::Vector3d(x, y, z));
    base_from_sensor.rotate(Rotation());
    return base_from_sensor;
  }
};

}  // namespace scan_image_slam
