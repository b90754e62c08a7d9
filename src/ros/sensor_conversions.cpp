#include "scan_image_slam/ros/sensor_conversions.h"

#include "scan_image_slam/core/recording/number_text.h"

#include <cmath>
#include <stdexcept>

namespace scan_image_slam {
namespace {

Eigen::Quaterniond ToQuaternion(double x, double y, double z, double w) {
  const Eigen::Quaterniond q(w, x, y, z);
  const double norm = q.norm();
  if (!(std::abs(norm - 1.0) < 0.1)) {
    throw std::invalid_argument("the orientation is not a unit quaternion: its norm is " +
                                std::to_string(norm));
  }
  return q.normalized();
}

}  // namespace

Stamp ToStamp(const ros::Time& time) {
  if (time.isZero()) throw std::invalid_argument("the stamp is zero: the driver has set none");
  if (time.nsec >= 1000000000U) {
    throw std::invalid_argument("the stamp has " + std::to_string(time.nsec) + " nanoseconds");
  }
  return static_cast<Stamp>(time.toNSec());
}

ros::Time ToRosTime(Stamp stamp) {
  ros::Time time;
  time.fromNSec(static_cast<std::uint64_t>(stamp));
  return time;
}

Stamp ClockNow() { return static_cast<Stamp>(ros::Time::now().toNSec()); }

Stamp SteadyNow() { return static_cast<Stamp>(ros::SteadyTime::now().toNSec()); }

LaserScan ToLaserScan(const sensor_msgs::LaserScan& message) {
  if (message.ranges.empty()) throw std::invalid_argument("the scan has no beams");
  if (message.ranges.size() > kMaxBeams) {
    throw std::invalid_argument("the scan has " + std::to_string(message.ranges.size()) +
                                " beams, at most " + std::to_string(kMaxBeams) + " are taken");
  }
  const bool finite = std::isfinite(message.angle_min) && std::isfinite(message.angle_increment) &&
                      std::isfinite(message.time_increment) && std::isfinite(message.range_min) &&
                      !std::isnan(message.range_max);
  if (!finite) throw std::invalid_argument("the geometry of the scan is not finite");
  if (message.angle_increment == 0.0f && message.ranges.size() > 1) {
    throw std::invalid_argument("angle_increment is zero");
  }
  if (std::abs(message.angle_increment) * static_cast<double>(message.ranges.size() - 1) >
      2.0 * M_PI + 0.1) {
    throw std::invalid_argument(
        "the scan covers more than a turn: angle_increment or the number of "
        "beams is wrong");
  }
  if (!(std::abs(message.time_increment) * static_cast<double>(message.ranges.size()) <
        kLongestSweep)) {
    throw std::invalid_argument("the scan takes longer than " + NumberText(kLongestSweep, 0) +
                                " s: time_increment is wrong");
  }
  LaserScan scan;
  scan.stamp = ToStamp(message.header.stamp);
  scan.angle_min = message.angle_min;
  scan.angle_increment = message.angle_increment;
  scan.time_increment = message.time_increment;
  scan.range_min = message.range_min;
  scan.range_max = message.range_max;
  scan.ranges = message.ranges;
  return scan;
}

bool IsPlausiblePosition(double x, double y) {
  constexpr double kFarthest = 1e8;  // more than twice around the earth [m]
  return std::abs(x) <= kFarthest && std::abs(y) <= kFarthest;
}

Pose2 ToPose2(const geometry_msgs::Pose& pose) {
  const auto& p = pose.position;
  if (!IsPlausiblePosition(p.x, p.y)) {
    throw std::invalid_argument("the position is not finite, or out of this world");
  }
  const auto& o = pose.orientation;
  const Eigen::Quaterniond q = ToQuaternion(o.x, o.y, o.z, o.w);
  const Eigen::Vector3d forward = q * Eigen::Vector3d::UnitX();
  return {p.x, p.y, std::atan2(forward.y(), forward.x())};
}

Eigen::Isometry3d ToIsometry(const geometry_msgs::Transform& transform) {
  const auto& t = transform.translation;
  if (!IsPlausiblePosition(t.x, t.y) || !IsPlausiblePosition(t.z, 0.0)) {
    throw std::invalid_argument("the translation is not finite, or out of this world");
  }
  const auto& r = transform.rotation;
  Eigen::Isometry3d isometry(ToQuaternion(r.x, r.y, r.z, r.w));
  isometry.pretranslate(Eigen::Vector3d(t.x, t.y, t.z));
  return isometry;
}

geometry_msgs::Transform ToTransformMessage(const Eigen::Isometry3d& isometry) {
  const Eigen::Quaterniond q(isometry.linear());
  geometry_msgs::Transform message;
  message.translation.x = isometry.translation().x();
  message.translation.y = isometry.translation().y();
  message.translation.z = isometry.translation().z();
  message.rotation.x = q.x();
  message.rotation.y = q.y();
  message.rotation.z = q.z();
  message.rotation.w = q.w();
  return message;
}

Pose2 ToPose2(const Eigen::Isometry3d& pose) {
  return {pose.translation().x(), pose.translation().y(),
          std::atan2(pose.linear()(1, 0), pose.linear()(0, 0))};
}

CameraIntrinsics ToCameraIntrinsics(const sensor_msgs::CameraInfo& message) {
  constexpr std::uint32_t kMaxSide = 16384;
  const sensor_msgs::RegionOfInterest& roi = message.roi;
  for (const std::uint32_t side :
       {message.width, message.height, roi.width, roi.height, roi.x_offset, roi.y_offset}) {
    if (side > kMaxSide) {
      throw std::invalid_argument("a size or place of " + std::to_string(side) +
                                  " pixels is too large for an image");
    }
  }
  CameraIntrinsics intrinsics;
  const double binning_x = std::max<std::uint32_t>(1, message.binning_x);
  const double binning_y = std::max<std::uint32_t>(1, message.binning_y);
  const bool whole = roi.width == 0 || roi.height == 0;
  const double width = whole ? message.width : roi.width;
  const double height = whole ? message.height : roi.height;
  intrinsics.width = static_cast<int>(width / binning_x);
  intrinsics.height = static_cast<int>(height / binning_y);
  for (int i = 0; i < 9; ++i) intrinsics.k.val[i] = message.K[i];
  intrinsics.k(0, 0) /= binning_x;
  intrinsics.k(0, 2) = (intrinsics.k(0, 2) - roi.x_offset) / binning_x;
  intrinsics.k(1, 1) /= binning_y;
  intrinsics.k(1, 2) = (intrinsics.k(1, 2) - roi.y_offset) / binning_y;
  intrinsics.distortion_model = message.distortion_model;
  intrinsics.d = message.D;
  intrinsics.Validate();
  return intrinsics;
}

Eigen::Isometry3d ToIsometry(const SensorPose& pose) {
  return Eigen::Translation3d(pose.x, pose.y, pose.z) *
         Eigen::AngleAxisd(pose.yaw, Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(pose.pitch, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(pose.roll, Eigen::Vector3d::UnitX());
}

Eigen::Isometry3d ToOpticalIsometry(const SensorPose& pose) {
  Eigen::Matrix3d body_from_optical;
  body_from_optical << 0, 0, 1,  //
      -1, 0, 0,                  //
      0, -1, 0;
  return ToIsometry(pose) * Eigen::Isometry3d(body_from_optical);
}

std::string StripSlash(const std::string& frame) {
  return !frame.empty() && frame.front() == '/' ? frame.substr(1) : frame;
}

}  // namespace scan_image_slam
