#pragma once

#include "scan_image_slam/core/simulation/robot_simulation.h"

#include <memory>
#include <string>

#include <geometry_msgs/Twist.h>
#include <image_transport/image_transport.h>
#include <ros/node_handle.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>

namespace scan_image_slam {

/// The simulated robot in real time: publishes `scan`, `image_raw`, `camera_info`, `odom` and TF
/// like the drivers of a real one; takes `cmd_vel`. Its true pose goes out on `ground_truth`, for
/// evaluation only. `simulation_finished` says that the path is driven.
class RobotSimulatorNode {
 public:
  /// Parameters: world (name or file), path, seed, images, noise, follow_path, and frame_prefix,
  /// which goes before the names of all frames. Throws std::runtime_error or std::invalid_argument
  /// if one is wrong.
  RobotSimulatorNode(ros::NodeHandle node, ros::NodeHandle private_node);

 private:
  void OnTimer();
  void OnCommand(const geometry_msgs::TwistConstPtr& message);
  void Publish(const LaserScan& scan);
  void Publish(const CameraFrame& frame);
  void Publish(const OdometryReading& reading);
  void Publish(const GroundTruth& truth);

  std::string frame_prefix_;  ///< but for the world's, in which the true pose is told
  std::unique_ptr<RobotSimulation> simulation_;
  sensor_msgs::CameraInfo camera_info_;
  bool finished_ = false;
  ros::WallTime last_command_;
  ros::Publisher scan_publisher_;
  ros::Publisher camera_info_publisher_;
  ros::Publisher odom_publisher_;
  ros::Publisher truth_publisher_;
  ros::Publisher finished_publisher_;
  image_transport::Publisher image_publisher_;
  tf2_ros::TransformBroadcaster transforms_;
  tf2_ros::StaticTransformBroadcaster static_transforms_;
  ros::Subscriber command_subscriber_;
  ros::WallTimer timer_;
};

}  // namespace scan_image_slam
