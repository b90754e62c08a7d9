#pragma once

#include "scan_image_slam/core/calibration/range_jump.h"
#include "scan_image_slam/core/evaluation/trajectory.h"
#include "scan_image_slam/core/fusion/scan_image_fusion.h"

#include <vector>

#include <Eigen/Core>

namespace scan_image_slam {

/// A vertical edge of a picture, by the attitude that the camera is assumed to have.
struct ViewedEdge {
  double bearing = 0.0;  ///< in the base frame [rad]
  double slope = 0.0;    ///< of the ray to its middle: height per horizontal distance [-]
  double lean = 0.0;     ///< how its bearing grows with the slope: 0 if it stands upright [rad]
  double lean_stddev = 0.0;
};

/// A range discontinuity of the scan next to the picture.
struct ViewedJump {
  Stamp fired = 0;                ///< time of the beam [ns]
  Eigen::Vector2d in_base{0, 0};  ///< in the base frame at that time [m]
  int side = 0;                   ///< as RangeJump::side
  double bearing_stddev = 0.0;    ///< [rad]
};

/// What the laser and the camera saw at about the same time.
struct CalibrationView {
  Stamp stamp = 0;  ///< of the picture [ns]
  std::vector<ViewedEdge> edges;
  std::vector<ViewedJump> jumps;
};

/// What a drive says of the camera's place on the robot.
struct CalibrationData {
  Trajectory trajectory;  ///< of the base, without help of the camera, at the stamps of the scans
  std::vector<CalibrationView> views;
  Eigen::Vector2d camera{0, 0};  ///< assumed place in the base frame [m]
  double pixel = 0.0;            ///< angle of one pixel in the middle of the picture [rad]
};

/// The view of the last image of `fusion`, with which `model` was made.
CalibrationView MakeCalibrationView(const ScanImageFusion& fusion, const FusedModel& model,
                                    const RangeJumpOptions& options);

}  // namespace scan_image_slam
