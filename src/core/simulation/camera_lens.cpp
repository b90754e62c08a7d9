#include "scan_image_slam/core/simulation/camera_lens.h"

#include <cmath>
#include <stdexcept>

#include <Eigen/LU>

namespace scan_image_slam {
namespace {

/// Distorted image coordinates at focal length 1, and their derivative.
struct Distorted {
  Eigen::Vector2d point;
  Eigen::Matrix2d jacobian;
};

Distorted Distort(const std::array<double, 5>& d, const Eigen::Vector2d& p) {
  const auto [k1, k2, p1, p2, k3] = d;
  const double x = p.x();
  const double y = p.y();
  const double r2 = x * x + y * y;
  const double radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
  const double slope = k1 + r2 * (2.0 * k2 + r2 * 3.0 * k3);  // of radial over r2
  Distorted result;
  result.point = {x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
                  y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y};
  const double mixed = 2.0 * x * y * slope + 2.0 * p1 * x + 2.0 * p2 * y;
  result.jacobian << radial + 2.0 * x * x * slope + 2.0 * p1 * y + 6.0 * p2 * x, mixed,  //
      mixed, radial + 2.0 * y * y * slope + 6.0 * p1 * y + 2.0 * p2 * x;
  return result;
}

CameraLens MakeLens(const CameraSimulatorOptions& o, double focal_error) {
  CameraLens lens;
  lens.width = o.width;
  lens.height = o.height;
  lens.fx = (1.0 + focal_error) * 0.5 * o.width / std::tan(0.5 * o.field_of_view);
  lens.fy = lens.fx;
  lens.cx = 0.5 * (o.width - 1) + o.centre_x;
  lens.cy = 0.5 * (o.height - 1) + o.centre_y;
  lens.distortion = {o.k1, o.k2, o.p1, o.p2, o.k3};
  return lens;
}

}  // namespace

Eigen::Vector2d CameraLens::Project(const Eigen::Vector3d& point) const {
  const Eigen::Vector2d p = Distort(distortion, point.head<2>() / point.z()).point;
  return {fx * p.x() + cx, fy * p.y() + cy};
}

Eigen::Vector3d CameraLens::Ray(const Eigen::Vector2d& pixel) const {
  const Eigen::Vector2d wanted((pixel.x() - cx) / fx, (pixel.y() - cy) / fy);
  Eigen::Vector2d p = wanted;
  for (int iteration = 0; iteration < 50; ++iteration) {
    const Distorted now = Distort(distortion, p);
    const Eigen::Vector2d error = wanted - now.point;
    // Beyond the fold of a strong barrel the derivative changes its sign.
    if (now.jacobian.determinant() <= 0.05) break;
    if (error.norm() < 1e-12) return {p.x(), p.y(), 1.0};
    p += now.jacobian.inverse() * error;
  }
  throw std::domain_error("the distortion cannot be undone over the whole image");
}

CameraLens TrueLens(const CameraSimulatorOptions& options) { return MakeLens(options, 0.0); }

CameraLens CalibratedLens(const CameraSimulatorOptions& options) {
  return MakeLens(options, options.calibration_focal_error);
}

MountPose CalibratedMount(const CameraSimulatorOptions& options) {
  MountPose mount = options.mount;
  mount.yaw += options.calibration_yaw_error;
  mount.pitch += options.calibration_pitch_error;
  mount.roll += options.calibration_roll_error;
  return mount;
}

Eigen::Matrix3d BodyFromOptical() {
  Eigen::Matrix3d body_from_optical;
  body_from_optical << 0, 0, 1,  //
      -1, 0, 0,                  //
      0, -1, 0;
  return body_from_optical;
}

}  // namespace scan_image_slam
