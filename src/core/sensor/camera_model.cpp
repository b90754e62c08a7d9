#include "scan_image_slam/core/sensor/camera_model.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <opencv2/calib3d.hpp>

namespace scan_image_slam {
namespace {

bool IsFisheye(const CameraIntrinsics& intrinsics) {
  return intrinsics.distortion_model == "equidistant" || intrinsics.distortion_model == "fisheye";
}

void RequireCoefficients(const CameraIntrinsics& intrinsics) {
  const std::size_t n = intrinsics.d.size();
  if (IsFisheye(intrinsics)) {
    if (n == 0 || n == 4) return;
  } else if (intrinsics.distortion_model == "rational_polynomial") {
    if (n == 0 || n == 8 || n == 12 || n == 14) return;
  } else if (intrinsics.distortion_model == "plumb_bob" || intrinsics.distortion_model.empty()) {
    if (n == 0 || n == 4 || n == 5) return;
  } else {
    throw std::invalid_argument("unknown distortion_model '" + intrinsics.distortion_model +
                                "' (known: plumb_bob, rational_polynomial, equidistant)");
  }
  throw std::invalid_argument("distortion_model '" + intrinsics.distortion_model + "' with " +
                              std::to_string(n) + " coefficients in D");
}

}  // namespace

void CameraIntrinsics::Validate() const {
  if (width <= 0 || height <= 0) {
    throw std::invalid_argument("image size " + std::to_string(width) + " x " +
                                std::to_string(height));
  }
  if (!(k(0, 0) > 0.0 && k(1, 1) > 0.0)) {
    throw std::invalid_argument("K[0] or K[4] is not positive: the camera is not calibrated");
  }
  for (const double value : k.val) {
    if (!std::isfinite(value)) throw std::invalid_argument("K holds a value that is not finite");
  }
  for (const double value : d) {
    if (!std::isfinite(value)) throw std::invalid_argument("D holds a value that is not finite");
  }
  RequireCoefficients(*this);
}

CameraModel::CameraModel(const CameraIntrinsics& intrinsics) : intrinsics_(intrinsics) {
  intrinsics_.Validate();
  if (intrinsics_.d.empty()) intrinsics_.d.assign(4, 0.0);
  // Polynomials fold points far outside the picture back into it; what the border sees is the
  // limit.
  std::vector<cv::Point2d> border;
  constexpr int kSteps = 16;
  for (int i = 0; i <= kSteps; ++i) {
    const double u = (intrinsics_.width - 1.0) * i / kSteps;
    const double v = (intrinsics_.height - 1.0) * i / kSteps;
    border.emplace_back(u, 0.0);
    border.emplace_back(u, intrinsics_.height - 1.0);
    border.emplace_back(0.0, v);
    border.emplace_back(intrinsics_.width - 1.0, v);
  }
  max_squared_radius_ = 0.0;
  for (const cv::Point2d& p : Undistort(border)) {
    max_squared_radius_ = std::max(max_squared_radius_, p.dot(p));
  }
  max_squared_radius_ *= 1.02;  // beyond the centres of the outermost pixels
}

std::vector<cv::Point2d> CameraModel::Undistort(const std::vector<cv::Point2d>& pixels) const {
  std::vector<cv::Point2d> points;
  if (IsFisheye(intrinsics_)) {
    cv::fisheye::undistortPoints(pixels, points, intrinsics_.k, intrinsics_.d);
  } else {
    const cv::TermCriteria criteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 50, 1e-10);
    cv::undistortPoints(pixels, points, intrinsics_.k, intrinsics_.d, cv::noArray(), cv::noArray(),
                        criteria);
  }
  return points;
}

std::vector<cv::Point2f> CameraModel::Project(const std::vector<cv::Point3d>& points) const {
  std::vector<cv::Point2f> pixels(points.size(), cv::Point2f(-1.0f, -1.0f));
  std::vector<cv::Point3d> visible;
  std::vector<std::size_t> where;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const cv::Point3d& p = points[i];
    if (p.z <= 0.0 || p.x * p.x + p.y * p.y > max_squared_radius_ * p.z * p.z) continue;
    visible.push_back(p);
    where.push_back(i);
  }
  if (visible.empty()) return pixels;
  std::vector<cv::Point2d> projected;
  const cv::Vec3d zero(0.0, 0.0, 0.0);
  if (IsFisheye(intrinsics_)) {
    cv::fisheye::projectPoints(visible, projected, zero, zero, intrinsics_.k, intrinsics_.d);
  } else {
    cv::projectPoints(visible, zero, zero, intrinsics_.k, intrinsics_.d, projected);
  }
  for (std::size_t i = 0; i < where.size(); ++i) {
    const cv::Point2d& p = projected[i];
    if (p.x < -0.5 || p.y < -0.5 || p.x >= intrinsics_.width - 0.5 ||
        p.y >= intrinsics_.height - 0.5) {
      continue;
    }
    pixels[where[i]] = cv::Point2f(static_cast<float>(p.x), static_cast<float>(p.y));
  }
  return pixels;
}

Eigen::Vector3d CameraModel::Ray(double u, double v) const {
  const cv::Point2d p = Undistort({cv::Point2d(u, v)}).front();
  return Eigen::Vector3d(p.x, p.y, 1.0).normalized();
}

}  // namespace scan_image_slam
