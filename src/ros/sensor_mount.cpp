#include "scan_image_slam/ros/sensor_mount.h"

#include "scan_image_slam/ros/sensor_conversions.h"
#include "scan_image_slam/ros/sensor_frames.h"

#include <utility>

namespace scan_image_slam {
namespace {

constexpr double kLookUpPeriod = 1.0;  // of a pose that is known already [s]

bool Differ(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  constexpr double kDistance = 1e-4;  // [m]
  constexpr double kAngle = 1e-4;     // [rad]
  const Eigen::Isometry3d d = a.inverse() * b;
  return d.translation().norm() > kDistance || Eigen::AngleAxisd(d.linear()).angle() > kAngle;
}

}  // namespace

SensorMount::SensorMount(std::string kind, const SensorPose& pose, bool optical,
                         std::string base_frame, const tf2_ros::Buffer* tf, InputWatch* watch,
                         tf2_ros::StaticTransformBroadcaster* broadcaster)
    : kind_(std::move(kind)),
      pose_(pose),
      optical_(optical),
      base_frame_(std::move(base_frame)),
      tf_(tf),
      watch_(watch),
      broadcaster_(broadcaster) {}

bool SensorMount::Update(const std::string& sensor_frame) {
  changed_ = false;
  if (sensor_frame != sensor_frame_) base_from_sensor_.reset();
  sensor_frame_ = sensor_frame;
  const ros::WallTime now = ros::WallTime::now();
  if (base_from_sensor_ && (now - looked_up_).toSec() < kLookUpPeriod) return true;
  looked_up_ = now;
  FrameLookup lookup;
  if (pose_.from_tf) {
    lookup = LookUpSensor(*tf_, base_frame_, sensor_frame);
  } else {
    lookup.found = true;
    lookup.base_from_sensor = optical_ ? ToOpticalIsometry(pose_) : ToIsometry(pose_);
  }
  // A transform that was known and is gone for a moment does not move the sensor.
  if (!base_from_sensor_) watch_->SetProblem(kind_ + " transform", lookup.problem);
  if (!lookup.found) return base_from_sensor_.has_value();
  changed_ = !base_from_sensor_ || Differ(*base_from_sensor_, lookup.base_from_sensor);
  if (changed_) {
    base_from_sensor_ = lookup.base_from_sensor;
    Publish();
  }
  return true;
}

void SensorMount::Publish() const {
  const std::string frame = StripSlash(sensor_frame_);
  const std::string base = StripSlash(base_frame_);
  if (broadcaster_ == nullptr || pose_.from_tf || frame.empty() || frame == base) return;
  geometry_msgs::TransformStamped transform;
  transform.header.stamp = ros::Time::now();
  transform.header.frame_id = base;
  transform.child_frame_id = frame;
  transform.transform = ToTransformMessage(*base_from_sensor_);
  broadcaster_->sendTransform(transform);
}

}  // namespace scan_image_slam
