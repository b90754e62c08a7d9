#pragma once

#include "scan_image_slam/core/sensor/camera_model.h"

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

namespace scan_image_slam {

/// Maps a camera's picture to one in which vertical in the world is vertical in the picture,
/// however the camera is pitched or rolled: a column is a bearing, a row is a slope (height per
/// horizontal distance), both seen from the camera's centre. Columns go from left to right, so
/// bearings fall; rows go downwards, so slopes fall. A vertical edge is long and must be found to a
/// fraction of a column, so rows are coarser than columns.
class BearingImage {
 public:
  /// `base_from_camera` takes points of the optical frame to the base frame. Throws
  /// std::invalid_argument if the camera looks up or down so steeply that it sees no horizon, or if
  /// its focal lengths are far from any that its picture can have.
  BearingImage(const CameraModel& camera, const Eigen::Isometry3d& base_from_camera);

  int columns() const { return map_.cols; }
  int rows() const { return map_.rows; }
  /// Camera centre in the base frame [m].
  const Eigen::Vector3d& centre() const { return centre_; }

  double Bearing(double column) const { return max_bearing_ - column * step_; }  ///< [rad]
  double Column(double bearing) const { return (max_bearing_ - bearing) / step_; }
  double Slope(double row) const { return max_slope_ - row * row_step(); }  ///< [-]
  double Row(double slope) const { return (max_slope_ - slope) / row_step(); }
  double step() const { return step_; }                   ///< one column [rad]
  double row_step() const { return kRowPixels * step_; }  ///< one row [-]

  /// Rows of the camera's picture in a row of this one, where it looks straight ahead.
  static constexpr int kRowPixels = 4;

  /// Rows [begin, end) of the picture, resampled. `grey` is CV_8U of the camera's size; what the
  /// camera does not see is black, and not `Sees`.
  cv::Mat Resample(const cv::Mat& grey, int begin, int end) const;

  /// CV_8U, 255 where the camera sees, with a margin of two columns and a row to its border.
  const cv::Mat& mask() const { return mask_; }

  /// Where a place of this picture is in the camera's picture [px]; (-1, -1) if outside.
  cv::Point2f CameraPixel(int column, int row) const;

 private:
  Eigen::Vector3d centre_;
  double max_bearing_ = 0.0;
  double max_slope_ = 0.0;
  double step_ = 0.0;
  cv::Mat map_;          // CV_32FC2
  int pooled_rows_ = 1;  // of the camera's picture, averaged before it is resampled
  cv::Mat fixed_map_;    // CV_16SC2: whole pixels of the averaged picture
  cv::Mat fraction_;     // CV_16UC1: interpolation
  cv::Mat mask_;
};

}  // namespace scan_image_slam
