#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

namespace scan_image_slam {

/// Lens and sensor of a camera, with the meanings of sensor_msgs/CameraInfo.
struct CameraIntrinsics {
  int width = 0;                               ///< [px]
  int height = 0;                              ///< [px]
  cv::Matx33d k = cv::Matx33d::zeros();        ///< fx 0 cx, 0 fy cy, 0 0 1 [px]
  std::string distortion_model = "plumb_bob";  ///< or rational_polynomial, equidistant
  std::vector<double> d;                       ///< distortion coefficients; empty: none

  /// Throws std::invalid_argument, saying what is wrong: zero K (not calibrated), no size, unknown
  /// distortion model or wrong number of coefficients.
  void Validate() const;
};

/// Where points in front of a camera are seen. A lens that sees more than 180 degrees is used for
/// what is in front of it.
class CameraModel {
 public:
  /// Throws as CameraIntrinsics::Validate.
  explicit CameraModel(const CameraIntrinsics& intrinsics);

  const CameraIntrinsics& intrinsics() const { return intrinsics_; }

  /// Pixels of points in the optical frame (x right, y down, z forward; shape n x 3) [m]. Points
  /// behind the camera or outside the image come back as (-1, -1).
  std::vector<cv::Point2f> Project(const std::vector<cv::Point3d>& points) const;

  /// Unit ray of a pixel in the optical frame.
  Eigen::Vector3d Ray(double u, double v) const;

 private:
  std::vector<cv::Point2d> Undistort(const std::vector<cv::Point2d>& pixels) const;

  CameraIntrinsics intrinsics_;
  double max_squared_radius_;  ///< of the border, in the plane at distance 1
};

}  // namespace scan_image_slam
