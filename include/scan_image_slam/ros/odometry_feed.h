#pragma once

#include "scan_image_slam/core/config/node_options.h"
#include "scan_image_slam/core/geometry/pose2.h"
#include "scan_image_slam/core/sensor/stamp.h"
#include "scan_image_slam/ros/input_watch.h"

#include <functional>
#include <optional>
#include <string>

#include <nav_msgs/Odometry.h>
#include <ros/node_handle.h>
#include <tf2_ros/buffer.h>

namespace scan_image_slam {

/// Brings the encoders' poses, from the topic odom or from TF, to a node.
class OdometryFeed {
 public:
  using OnPose = std::function<void(Stamp, const Pose2& odom_from_base)>;
  /// `tf` and `watch` must outlive the feed.
  OdometryFeed(ros::NodeHandle node, const OdometryInput& input, const tf2_ros::Buffer* tf,
               InputWatch* watch, OnPose on_pose);

 private:
  void ExpectTopic();
  void OnOdometry(const nav_msgs::OdometryConstPtr& message);
  bool FindBase(const std::string& child);
  void CheckFrame(const std::string& frame);
  void PollTransform();
  void WatchTransform();

  OdometryInput input_;
  const tf2_ros::Buffer* tf_;
  InputWatch* watch_;
  OnPose on_pose_;
  ros::Subscriber subscriber_;
  ros::WallTimer timer_;
  ros::WallTime first_message_;
  ros::WallTime last_message_;
  std::optional<std::string> child_;  ///< whose poses the messages tell, if it is known where it is
  Pose2 child_from_base_;
  bool by_transform_;  ///< not by a topic
  ros::Time last_transform_;
  ros::WallTime last_change_;  ///< of the transform
};

}  // namespace scan_image_slam
