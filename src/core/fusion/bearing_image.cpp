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

/// Many times what a large camera has; without a bound a wrong calibration would take all memory.
constexpr double kMaxCells = 1 << 24;

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

/// How many rows of the camera's picture can be averaged without blurring a vertical edge, which
/// leans as the columns of the map do.
int RowsToPool(const cv::Mat& map) {
  constexpr double kMaxShift = 0.5;  // [px]
  double lean = 0.0;
  for (int row = 1; row < map.rows; ++row) {
    for (int column = 0; column < map.cols; ++column) {
      const cv::Point2f above = map.at<cv::Point2f>(row - 1, column);
      const cv::Point2f here = map.at<cv::Point2f>(row, column);
      if (above.x < 0.0f || here.x < 0.0f) continue;
      const cv::Point2f along = here - above;
      lean = std::max<double>(lean, std::abs(along.x) / std::max(std::abs(along.y), 1e-6f));
    }
  }
  int rows = BearingImage::kRowPixels;
  while (rows > 1 && rows * lean > kMaxShift) rows /= 2;
  return rows;
}

/// Means of `pooled` rows each.
cv::Mat PoolRows(const cv::Mat& grey, int pooled) {
  if (pooled == 1) return grey;
  cv::Mat means(grey.rows / pooled, grey.cols, CV_8U);
  std::vector<std::uint16_t> sums(grey.cols);
  for (int y = 0; y < means.rows; ++y) {
    std::fill(sums.begin(), sums.end(), pooled / 2);
    for (int i = 0; i < pooled; ++i) {
      const auto* row = grey.ptr<std::uint8_t>(pooled * y + i);
      for (int x = 0; x < grey.cols; ++x) sums[x] = static_cast<std::uint16_t>(sums[x] + row[x]);
    }
    auto* mean = means.ptr<std::uint8_t>(y);
    const int shift = pooled == 4 ? 2 : 1;
    for (int x = 0; x < grey.cols; ++x) mean[x] = static_cast<std::uint8_t>(sums[x] >> shift);
  }
  return means;
}

}  // namespace

BearingImage::BearingImage(const CameraModel& camera, const Eigen::Isometry3d& base_from_camera)
    : centre_(base_from_camera.translation()) {
  const Extent extent = FindExtent(camera, base_from_camera);
  // One column per pixel in the middle of the picture keeps the resolution.
  step_ = 1.0 / std::max(camera.intrinsics().k(0, 0), camera.intrinsics().k(1, 1));
  max_bearing_ = extent.heading + extent.max_bearing;
  max_slope_ = extent.max_slope;
  const double width = 1.0 + (extent.max_bearing - extent.min_bearing) / step_;
  const double height = 1.0 + (extent.max_slope - extent.min_slope) / row_step();
  if (!(width * height <= kMaxCells)) {
    throw std::invalid_argument("K[0] and K[4] do not fit each other or the size of the picture");
  }
  const auto columns = static_cast<int>(width);
  const auto rows = static_cast<int>(height);

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
  pooled_rows_ = RowsToPool(map_);
  cv::Mat pooled_map = map_.clone();
  for (auto p = pooled_map.begin<cv::Point2f>(); p != pooled_map.end<cv::Point2f>(); ++p) {
    if ((*p).y >= 0.0f) (*p).y = ((*p).y + 0.5f) / static_cast<float>(pooled_rows_) - 0.5f;
  }
  cv::convertMaps(pooled_map, cv::noArray(), fixed_map_, fraction_, CV_16SC2);

  cv::Mat inside(rows, columns, CV_8U);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const bool sees = map_.at<cv::Point2f>(row, column).x >= 0.0f &&
                        map_.at<cv::Point2f>(row, column).y >= 0.0f;
      inside.at<std::uint8_t>(row, column) = sees ? 255 : 0;
    }
  }
  cv::erode(inside, mask_, cv::Mat::ones(3, 5, CV_8U), cv::Point(-1, -1), 1, cv::BORDER_CONSTANT,
            cv::Scalar(0));
}

cv::Mat BearingImage::Resample(const cv::Mat& grey, int begin, int end) const {
  cv::Mat resampled;
  cv::remap(PoolRows(grey, pooled_rows_), resampled, fixed_map_.rowRange(begin, end),
            fraction_.rowRange(begin, end), cv::INTER_LINEAR, cv::BORDER_CONSTANT, cv::Scalar(0));
  return resampled;
}

cv::Point2f BearingImage::CameraPixel(int column, int row) const {
  return map_.at<cv::Point2f>(row, column);
}

}  // namespace scan_image_slam
