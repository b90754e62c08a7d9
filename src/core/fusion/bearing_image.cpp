#include "scan_image_slam/core/fusion/bearing_image.h"

#include "scan_image_slam/core/geometry/pose2.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include <opencv2/imgproc.hpp>

namespace scan_image_slam {
namespace {

/// Steeper rays say nothing of bearings.
constexpr double kMaxSlope = 3.0;

struct Extent {
  double heading = 0.0;  ///< of the optical axis, or of what is up for a camera that looks down
  double min_bearing = 0.0;
  double max_bearing = 0.0;
  double min_slope = 0.0;
  double max_slope = 0.0;
};

/// What the border and the inside of the picture see, as bearings around the camera's heading.
Extent FindExtent(const CameraModel& camera, const Eigen::Isometry3d& base_from_camera) {
  const Eigen::Vector3d axis = base_from_camera.linear() * Eigen::Vector3d::UnitZ();
  if (std::hypot(axis.x(), axis.y()) < 0.3) {
    throw std::invalid_argument("the camera looks almost straight up or down: no walls in view");
  }
  Extent extent;
  extent.heading = std::atan2(axis.y(), axis.x());
  constexpr int kSteps = 24;
  bool first = true;
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j <= kSteps; ++j) {
      const Eigen::Vector3d ray =
          base_from_camera.linear() * camera.Ray((camera.intrinsics().width - 1.0) * i / kSteps,
                                                 (camera.intrinsics().height - 1.0) * j / kSteps);
      const double slope = ray.z() / std::hypot(ray.x(), ray.y());
      if (!(std::abs(slope) <= kMaxSlope)) continue;
      const double bearing = NormalizeAngle(std::atan2(ray.y(), ray.x()) - extent.heading);
      extent.min_bearing = first ? bearing : std::min(extent.min_bearing, bearing);
      extent.max_bearing = first ? bearing : std::max(extent.max_bearing, bearing);
      extent.min_slope = first ? slope : std::min(extent.min_slope, slope);
      extent.max_slope = first ? slope : std::max(extent.max_slope, slope);
      first = false;
    }
  }
  if (first) {
    throw std::invalid_argument("the camera sees nothing but steep rays: no walls in view");
  }
  return extent;
}

}  // namespace

BearingImage::BearingImage(const CameraModel& camera, const Eigen::Isometry3d& base_from_camera)
    : centre_(base_from_camera.translation()) {
  const Extent extent = FindExtent(camera, base_from_camera);
  // One column per pixel in the middle of the picture keeps the resolution.
  step_ = 1.0 / std::max(camera.intrinsics().k(0, 0), camera.intrinsics().k(1, 1));
  max_bearing_ = extent.heading + extent.max_bearing;
  max_slope_ = extent.max_slope;
  const int columns = 1 + static_cast<int>((extent.max_bearing - extent.min_bearing) / step_);
  const int rows = 1 + static_cast<int>((extent.max_slope - extent.min_slope) / step_);

  map_.create(rows, columns, CV_32FC2);
  const Eigen::Matrix3d camera_from_base = base_from_camera.linear().transpose();
  std::vector<cv::Point3d> rays(columns);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const double bearing = Bearing(column);
      const Eigen::Vector3d ray =
          camera_from_base * Eigen::Vector3d(std::cos(bearing), std::sin(bearing), Slope(row));
      rays[column] = cv::Point3d(ray.x(), ray.y(), ray.z());
    }
    const std::vector<cv::Point2f> pixels = camera.Project(rays);
    std::copy(pixels.begin(), pixels.end(), map_.ptr<cv::Point2f>(row));
  }
  cv::convertMaps(map_, cv::noArray(), fixed_map_, fraction_, CV_16SC2);

  cv::Mat inside(rows, columns, CV_8U);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const bool sees = map_.at<cv::Point2f>(row, column).x >= 0.0f &&
                        map_.at<cv::Point2f>(row, column).y >= 0.0f;
      inside.at<std::uint8_t>(row, column) = sees ? 255 : 0;
    }
  }
  cv::erode(inside, mask_, cv::Mat::ones(5, 5, CV_8U), cv::Point(-1, -1), 1, cv::BORDER_CONSTANT,
            cv::Scalar(0));
}

cv::Mat BearingImage::Resample(const cv::Mat& grey, int begin, int end) const {
  cv::Mat resampled;
  cv::remap(grey, resampled, fixed_map_.rowRange(begin, end), fraction_.rowRange(begin, end),
            cv::INTER_LINEAR, cv::BORDER_CONSTANT, cv::Scalar(0));
  return resampled;
}

cv::Point2f BearingImage::CameraPixel(int column, int row) const {
  return map_.at<cv::Point2f>(row, column);
}

}  // namespace scan_image_slam
