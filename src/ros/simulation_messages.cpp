#include "scan_image_slam/ros/simulation_messages.h"

#include "scan_image_slam/ros/sensor_conversions.h"
#include "scan_image_slam/ros/slam_messages.h"

namespace scan_image_slam {
namespace {

geometry_msgs::TransformStamped StaticTransform(const MountPose& mount, const std::string& frame,
                                                const Eigen::Quaterniond& rotation, Stamp stamp) {
  geometry_msgs::TransformStamped message;
  message.header.stamp = ToRosTime(stamp);
  message.header.frame_id = "base_link";
  message.child_frame_id = frame;
  message.transform.translation.x = mount.x;
  message.transform.translation.y = mount.y;
  message.transform.translation.z = mount.z;
  message.transform.rotation.x = rotation.x();
  message.transform.rotation.y = rotation.y();
  message.transform.rotation.z = rotation.z();
  message.transform.rotation.w = rotation.w();
  return message;
}

}  // namespace

sensor_msgs::LaserScan ToMessage(const LaserScan& scan, double scan_time) {
  sensor_msgs::LaserScan message;
  message.header.stamp = ToRosTime(scan.stamp);
  message.header.frame_id = "laser";
  message.angle_min = static_cast<float>(scan.angle_min);
  message.angle_increment = static_cast<float>(scan.angle_increment);
  message.angle_max = static_cast<float>(scan.Bearing(scan.ranges.size() - 1));
  message.time_increment = static_cast<float>(scan.time_increment);
  message.scan_time = static_cast<float>(scan_time);
  message.range_min = static_cast<float>(scan.range_min);
  message.range_max = static_cast<float>(scan.range_max);
  message.ranges = scan.ranges;
  return message;
}

nav_msgs::Odometry ToMessage(const OdometryReading& reading) {
  nav_msgs::Odometry message;
  message.header.stamp = ToRosTime(reading.stamp);
  message.header.frame_id = "odom";
  message.child_frame_id = "base_link";
  message.pose.pose = ToPoseMessage(reading.odom_from_base);
  message.twist.twist.linear.x = reading.speed;
  message.twist.twist.angular.z = reading.turn_rate;
  return message;
}

geometry_msgs::TransformStamped ToTransform(const OdometryReading& reading) {
  geometry_msgs::TransformStamped message;
  message.header.stamp = ToRosTime(reading.stamp);
  message.header.frame_id = "odom";
  message.child_frame_id = "base_link";
  message.transform = ToTransformMessage(reading.odom_from_base);
  return message;
}

sensor_msgs::CameraInfo ToMessage(const CameraLens& lens, Stamp stamp) {
  sensor_msgs::CameraInfo message;
  message.header.stamp = ToRosTime(stamp);
  message.header.frame_id = "camera_optical_frame";
  message.width = static_cast<std::uint32_t>(lens.width);
  message.height = static_cast<std::uint32_t>(lens.height);
  message.distortion_model = "plumb_bob";
  message.D.assign(lens.distortion.begin(), lens.distortion.end());
  message.K = {lens.fx, 0, lens.cx, 0, lens.fy, lens.cy, 0, 0, 1};
  message.R = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  message.P = {lens.fx, 0, lens.cx, 0, 0, lens.fy, lens.cy, 0, 0, 0, 1, 0};
  return message;
}

std::string EncodingName(ImageEncoding encoding) {
  switch (encoding) {
    case ImageEncoding::kMono8:
      return "mono8";
    case ImageEncoding::kBayerRggb8:
      return "bayer_rggb8";
    case ImageEncoding::kBgr8:
      break;
  }
  return "bgr8";
}

sensor_msgs::Image ToMessage(const CameraFrame& frame) {
  sensor_msgs::Image message;
  message.header.stamp = ToRosTime(frame.stamp);
  message.header.frame_id = "camera_optical_frame";
  message.height = static_cast<std::uint32_t>(frame.pixels.rows);
  message.width = static_cast<std::uint32_t>(frame.pixels.cols);
  message.encoding = EncodingName(frame.encoding);
  message.step = static_cast<std::uint32_t>(frame.pixels.cols * frame.pixels.elemSize());
  message.data.assign(frame.pixels.datastart, frame.pixels.dataend);
  return message;
}

tf2_msgs::TFMessage StaticTransforms(const RobotSimulation& simulation, Stamp stamp) {
  const MountPose laser = simulation.laser_mount();
  const MountPose camera = simulation.camera_mount();
  tf2_msgs::TFMessage message;
  message.transforms.push_back(StaticTransform(laser, "laser", laser.Rotation(), stamp));
  message.transforms.push_back(
      StaticTransform(camera, "camera_optical_frame",
                      camera.Rotation() * Eigen::Quaterniond(BodyFromOptical()), stamp));
  return message;
}

geometry_msgs::PoseStamped ToMessage(const GroundTruth& truth) {
  geometry_msgs::PoseStamped message;
  message.header.stamp = ToRosTime(truth.stamp);
  message.header.frame_id = "world";
  message.pose = ToPoseMessage(truth.world_from_base);
  return message;
}

}  // namespace scan_image_slam
