#pragma once

#include "scan_image_slam/core/simulation/camera_options.h"

#include <array>

#include <Eigen/Core>

namespace scan_image_slam {

/// Pinhole with plumb_bob distortion, as camera_info describes it. Pixel (0, 0) is the middle of
/// the first pixel. Optical frame: x right, y down, z ahead.
struct CameraLens {
  int width = 0;                       ///< [px]
  int height = 0;                      ///< [px]
  double fx = 0.0;                     ///< [px]
  double fy = 0.0;                     ///< [px]
  double cx = 0.0;                     ///< [px]
  double cy = 0.0;                     ///< [px]
  std::array<double, 5> distortion{};  ///< k1, k2, p1, p2, k3

  /// Pixel of a point in the optical frame with z > 0.
  Eigen::Vector2d Project(const Eigen::Vector3d& point) const;

  /// Direction (x, y, 1) in the optical frame that is seen at a pixel. Throws std::domain_error if
  /// the distortion cannot be undone there (it folds the image).
  Eigen::Vector3d Ray(const Eigen::Vector2d& pixel) const;
};

/// The lens that the simulated camera has.
CameraLens TrueLens(const CameraSimulatorOptions& options);

/// The lens and the mount as the calibration says, with its errors.
CameraLens CalibratedLens(const CameraSimulatorOptions& options);
MountPose CalibratedMount(const CameraSimulatorOptions& options);

/// body_from_optical: turns the optical frame into one with x ahead, y left, z up.
Eigen::Matrix3d BodyFromOptical();

}  // namespace scan_image_slam
