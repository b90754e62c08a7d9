#pragma once

#include "scan_image_slam/core/config/node_options.h"
#include "scan_image_slam/ros/input_watch.h"

#include <optional>
#include <string>

#include <Eigen/Geometry>
#include <tf2_ros/buffer.h>
#include <tf2_ros/static_transform_broadcaster.h>

namespace scan_image_slam {

/// Where one sensor is on the robot, from TF or from parameters. It is looked up again now and
/// then: a transform that is published anew, with another value, is taken over.
class SensorMount {
 public:
  /// `kind` names the sensor in messages; `optical`: poses given by parameters are those of a
  /// camera. With a `broadcaster` such poses are published as static transforms.
  SensorMount(std::string kind, const SensorPose& pose, bool optical, std::string base_frame,
              const tf2_ros::Buffer* tf, InputWatch* watch,
              tf2_ros::StaticTransformBroadcaster* broadcaster);

  /// True if the pose is known; `changed` tells whether it is another than at the last call.
  bool Update(const std::string& sensor_frame);
  bool changed() const { return changed_; }
  const Eigen::Isometry3d& base_from_sensor() const { return *base_from_sensor_; }
  const std::string& sensor_frame() const { return sensor_frame_; }

 private:
  void Publish() const;

  std::string kind_;
  SensorPose pose_;
  bool optical_;
  std::string base_frame_;
  const tf2_ros::Buffer* tf_;
  InputWatch* watch_;
  tf2_ros::StaticTransformBroadcaster* broadcaster_;  ///< may be null
  std::string sensor_frame_;                          ///< of the last message
  std::optional<Eigen::Isometry3d> base_from_sensor_;
  ros::WallTime looked_up_;
  bool changed_ = false;
};

}  // namespace scan_image_slam
