#pragma once

#include "scan_image_slam/core/geometry/pose2.h"

#include <cmath>

#include <Eigen/Core>

namespace scan_image_slam {

/// Covariances of poses are those of a small motion (forward [m], left [m], turn [rad]) that is
/// applied in the frame of the base. This one carries such a covariance over a motion of the base:
/// an error before the motion, seen from after it (adjoint of the motion's inverse).
inline Eigen::Matrix3d TransportCovariance(const Eigen::Matrix3d& covariance, const Pose2& motion) {
  const double c = std::cos(motion.theta);
  const double s = std::sin(motion.theta);
  Eigen::Matrix3d adjoint;
  adjoint << c, s, s * motion.x - c * motion.y,  //
      -s, c, c * motion.x + s * motion.y,        //
      0, 0, 1;
  return adjoint * covariance * adjoint.transpose();
}

/// Of errors that are independent of one another, by their standard deviations [m, rad]: forward
/// and to the left the same.
inline Eigen::Matrix3d DiagonalCovariance(double distance, double angle) {
  return Eigen::Vector3d(distance * distance, distance * distance, angle * angle).asDiagonal();
}

}  // namespace scan_image_slam
