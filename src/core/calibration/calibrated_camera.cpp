#include "scan_image_slam/core/calibration/calibrated_camera.h"

#include <cmath>
#include <limits>

namespace scan_image_slam {

Eigen::Isometry3d Corrected(const Eigen::Isometry3d& base_from_camera,
                            const CalibrationVector& correction) {
  const Eigen::Vector3d tilt(correction[kTiltX], correction[kTiltY], 0.0);
  const Eigen::AngleAxisd turn(correction[kYaw], Eigen::Vector3d::UnitZ());
  Eigen::Isometry3d corrected = base_from_camera;
  corrected.linear() = turn.toRotationMatrix() *
                       Eigen::AngleAxisd(tilt.norm(), tilt.stableNormalized()).toRotationMatrix() *
                       base_from_camera.linear();
  corrected.translation() += Eigen::Vector3d(correction[kForward], correction[kLeft], 0.0);
  return corrected;
}

SensorPose CameraPose(const Eigen::Isometry3d& base_from_camera) {
  const Eigen::Matrix3d& optical = base_from_camera.linear();
  // Axes of the camera's body: it looks along x, y is to its left, z up.
  const Eigen::Vector3d ahead = optical.col(2);
  const Eigen::Vector3d left = -optical.col(0);
  const Eigen::Vector3d up = -optical.col(1);
  SensorPose pose;
  pose.from_tf = false;
  pose.x = base_from_camera.translation().x();
  pose.y = base_from_camera.translation().y();
  pose.z = base_from_camera.translation().z();
  pose.yaw = std::atan2(ahead.y(), ahead.x());
  pose.pitch = std::atan2(-ahead.z(), ahead.head<2>().norm());
  pose.roll = std::atan2(left.z(), up.z());
  return pose;
}

double RowOfLaserPlane(const CameraModel& camera, const Eigen::Isometry3d& base_from_camera,
                       double laser_height, double distance) {
  const Eigen::Vector3d axis = base_from_camera.linear().col(2);
  const Eigen::Vector2d ahead = axis.head<2>().normalized();
  Eigen::Vector3d point = base_from_camera.translation();
  point.head<2>() += distance * ahead;
  point.z() = laser_height;
  const Eigen::Vector3d p = base_from_camera.inverse() * point;
  const cv::Point2f pixel = camera.Project({cv::Point3d(p.x(), p.y(), p.z())}).front();
  return pixel.y < 0.0F ? std::numeric_limits<double>::quiet_NaN() : pixel.y;
}

}  // namespace scan_image_slam
