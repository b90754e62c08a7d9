#pragma once

#include "scan_image_slam/core/calibration/calibration_view.h"
#include "scan_image_slam/core/geometry/pose2.h"

#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Core>

namespace scan_image_slam {

/// What is estimated, each as a correction to what was assumed.
enum CalibrationIndex {
  kYaw,      ///< of the camera, to the left [rad]
  kForward,  ///< of its place [m]
  kLeft,     ///< [m]
  kTime,     ///< added to the stamps of the pictures [s]
  kTiltX,    ///< of the camera about the base's forward axis [rad]
  kTiltY,    ///< about the base's left axis [rad]
  kBorder,   ///< by which the laser's spot makes each surface wider [rad]; of no use to others
  kCalibrationSize
};
using CalibrationVector = std::array<double, kCalibrationSize>;

/// A range discontinuity as the base has it at the time of a picture.
struct JumpSight {
  int view = 0;
  Eigen::Vector2d point{0, 0};  ///< in the base frame at the time of the picture [m]
  Velocity2 velocity;           ///< of the base at that time
  double time_offset = 0.0;     ///< that the time of the picture was corrected by [s]
  int side = 0;
  double bearing_stddev = 0.0;  ///< [rad]
};

/// The discontinuities of all views, with the pictures' stamps corrected by `time_offset` [s].
/// Views at whose time the pose is not known have none.
std::vector<JumpSight> SightJumps(const CalibrationData& data, double time_offset);

/// The discontinuity as seen from the camera, by a correction; along the axes of the base [m].
template <typename T>
Eigen::Matrix<T, 2, 1> FromCamera(const JumpSight& sight, const Eigen::Vector2d& camera,
                                  const T* correction) {
  using std::cos;
  using std::sin;
  const T dt = correction[kTime] - sight.time_offset;
  const T turn = -sight.velocity.theta * dt;
  const T x = sight.point.x() - sight.velocity.x * dt;
  const T y = sight.point.y() - sight.velocity.y * dt;
  return {cos(turn) * x - sin(turn) * y - (camera.x() + correction[kForward]),
          sin(turn) * x + cos(turn) * y - (camera.y() + correction[kLeft])};
}

/// How far the picture's edge lies to the left of the discontinuity, seen from the camera, by a
/// correction [rad].
template <typename T>
T BearingResidual(const JumpSight& sight, const ViewedEdge& edge, const Eigen::Vector2d& camera,
                  const T* correction) {
  using std::atan2;
  using std::cos;
  using std::sin;
  const Eigen::Matrix<T, 2, 1> to_jump = FromCamera(sight, camera, correction);
  // A tilted camera sees what is above it in another bearing.
  const T tilt =
      correction[kTiltX] * std::cos(edge.bearing) + correction[kTiltY] * std::sin(edge.bearing);
  const T seen = edge.bearing - edge.slope * tilt + correction[kYaw] +
                 static_cast<double>(sight.side) * correction[kBorder];
  return atan2(to_jump.x() * sin(seen) - to_jump.y() * cos(seen),
               to_jump.x() * cos(seen) + to_jump.y() * sin(seen));
}

/// A discontinuity and an edge of the same view that are taken for the same thing.
struct CalibrationPair {
  JumpSight sight;
  ViewedEdge edge;
};

/// The nearest edge to each discontinuity, if it is nearer than `gate` [rad].
std::vector<CalibrationPair> PairNearest(const CalibrationData& data,
                                         const std::vector<JumpSight>& sights,
                                         const CalibrationVector& correction, double gate);

}  // namespace scan_image_slam
