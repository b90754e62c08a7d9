#pragma once

#include "scan_image_slam/core/simulation/camera_lens.h"

#include <cmath>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace scan_image_slam {

/// Raster of directions around a camera that is levelled, whatever its pitch and roll: a pinhole
/// whose columns are equal steps of the tangent of the bearing (to the left) and whose rows are
/// equal steps of the slope (height per horizontal distance, upwards). Upright lines of the world
/// are columns. Stored transposed: one line of the matrix is a column.
struct BearingGrid {
  double tangent_min = 0.0;  ///< of the first column's border, to the mount's yaw
  double tangent_step = 0.0;
  int columns = 0;
  double slope_min = 0.0;   ///< of the first row's border [m/m]
  double slope_step = 0.0;  ///< [m/m]
  int rows = 0;

  /// Unit vector in the plan; `column` counts borders, e.g. 0.5 for the middle of the first column.
  Eigen::Vector2d Ray(double column) const {
    return Eigen::Vector2d(1.0, tangent_min + column * tangent_step).normalized();
  }
  /// The inverse for a bearing in (-pi/2, pi/2).
  double Column(double bearing) const { return (std::tan(bearing) - tangent_min) / tangent_step; }
};

/// A grid that covers the image of a camera, and where each pixel lies in it.
struct BearingView {
  BearingGrid grid;
  cv::Mat map;           ///< CV_16SC2: row and column of the grid, whole part, for cv::remap
  cv::Mat map_fraction;  ///< CV_16UC1: the fraction, for cv::remap
};

/// Throws std::domain_error if the distortion folds the image, and std::invalid_argument if a pixel
/// looks more than 75 degrees up or down, or more than 80 degrees to a side.
BearingView MakeBearingView(const CameraLens& lens, const MountPose& mount);

}  // namespace scan_image_slam
