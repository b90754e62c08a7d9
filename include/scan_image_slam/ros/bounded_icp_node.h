#pragma once

#include "scan_image_slam/core/config/slam_parameters.h"
#include "scan_image_slam/core/matching/bounded_icp.h"
#include "scan_image_slam/core/sensor/odometry_gate.h"
#include "scan_image_slam/core/sensor/time_guard.h"
#include "scan_image_slam/ros/busy_time.h"
#include "scan_image_slam/ros/input_watch.h"
#include "scan_image_slam/ros/live_parameters.h"
#include "scan_image_slam/ros/odometry_feed.h"
#include "scan_image_slam/ros/wake_up.h"
#include <scan_image_slam/IcpModel.h>

#include <memory>
#include <optional>

#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <std_msgs/String.h>
#include <tf2_ros/transform_listener.h>

namespace scan_image_slam {

/// Node around BoundedIcp: `icp_model` and `odom` (or TF) in, `scan_match` out; on demand
/// `search_window`. The word "reset" on `syscommand` starts the matching over.
class BoundedIcpNode {
 public:
  /// Throws ParameterError or std::invalid_argument if the configuration is wrong.
  BoundedIcpNode(ros::NodeHandle node, ros::NodeHandle private_node);

 private:
  struct Options {
    BoundedIcpOptions bounded_icp;
    BoundedIcpNodeOptions node;
    ParameterSet Parameters() { return BoundedIcpParameters(&bounded_icp, &node); }
  };
  static Options ReadOptions(const ros::NodeHandle& private_node);
  void Take(const LiveParameters::Values& values);
  void OnModel(const ros::MessageEvent<const IcpModel>& event);
  void OnOdometry(Stamp stamp, const Pose2& odom_from_base);
  void OnCommand(const std_msgs::StringConstPtr& message);
  void ReleaseModels();
  void Publish(const MatchedMotion& match);
  MatchMode Mode() const;
  void CheckMatching();
  void CheckCalibration();
  void PublishWindow(const MatchedMotion& match);
  void StartOver();

  Options options_;
  BoundedIcp bounded_icp_;
  OdometryGate<FusedModel> gate_;
  InputWatch watch_;
  tf2_ros::Buffer tf_;
  tf2_ros::TransformListener tf_listener_;
  TimeGuard time_guard_;
  BusyTime match_time_;
  MatchedMotion last_match_;
  ros::WallTime matched_;           ///< of the last match
  std::optional<Stamp> odd_since_;  ///< of the first of the matches in a row that are none
  int window_edge_hits_ = 0;
  int matches_ = 0;

  ros::Publisher match_publisher_;
  ros::Publisher window_publisher_;
  ros::Subscriber model_subscriber_;
  ros::Subscriber command_subscriber_;
  std::unique_ptr<OdometryFeed> odometry_;
  WakeUp wake_up_;
  LiveParameters live_parameters_;
};

}  // namespace scan_image_slam
