#pragma once

#include "scan_image_slam/core/calibration/calibration_watch.h"
#include "scan_image_slam/core/config/slam_parameters.h"
#include "scan_image_slam/core/fusion/scan_image_fusion.h"
#include "scan_image_slam/core/matching/matched_motion.h"
#include "scan_image_slam/core/sensor/odometry_gate.h"
#include "scan_image_slam/core/sensor/time_guard.h"
#include "scan_image_slam/ros/busy_time.h"
#include "scan_image_slam/ros/input_watch.h"
#include "scan_image_slam/ros/live_parameters.h"
#include "scan_image_slam/ros/odometry_feed.h"
#include "scan_image_slam/ros/sensor_mount.h"
#include "scan_image_slam/ros/wake_up.h"
#include <scan_image_slam/ScanMatch.h>

#include <memory>
#include <optional>
#include <string>

#include <image_transport/image_transport.h>
#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/LaserScan.h>
#include <tf2_ros/transform_listener.h>

namespace scan_image_slam {

/// Node around ScanImageFusion: `scan`, `image_raw`, `camera_info`, `odom` and TF in, `icp_model`
/// out; on demand `fusion/image` and `fusion/edges`.
class ScanImageFusionNode {
 public:
  /// Throws ParameterError or std::invalid_argument if the configuration is wrong.
  ScanImageFusionNode(ros::NodeHandle node, ros::NodeHandle private_node);

 private:
  struct Options {
    ScanImageFusionOptions fusion;
    ScanImageFusionNodeOptions node;
    ParameterSet Parameters() { return FusionParameters(&fusion, &node); }
  };
  static Options ReadOptions(const ros::NodeHandle& private_node);
  void Take(const LiveParameters::Values& values);
  void SubscribeCamera(ros::NodeHandle node, const std::string& name);
  void OnScan(const ros::MessageEvent<const sensor_msgs::LaserScan>& event);
  void OnCameraInfo(const sensor_msgs::CameraInfoConstPtr& message);
  void LoseCamera();
  void OnImage(const sensor_msgs::ImageConstPtr& message);
  void OnCompressedImage(const sensor_msgs::CompressedImageConstPtr& message);
  void OnOdometry(Stamp stamp, const Pose2& odom_from_base);
  void ReleaseScans();
  void Publish(const FusedModel& model);
  void PreparePicture(const FusedModel& model);
  void OnMatch(const ScanMatchConstPtr& message);
  void PublishPicture(const MatchedMotion* match);
  void PublishEdges(const FusedModel& model);
  void WatchCalibration(const FusedModel& model);
  void ForgetCalibration();
  void StartOver();

  ros::NodeHandle node_;
  Options options_;
  ScanImageFusion fusion_;
  CalibrationWatch calibration_watch_;
  std::optional<CameraMisfit> misfit_;
  Stamp misfit_stamp_ = 0;  ///< of the scan at which it was looked at
  OdometryGate<LaserScan> gate_;
  InputWatch watch_;
  tf2_ros::Buffer tf_;
  tf2_ros::TransformListener tf_listener_;
  /// One for both mounts, as each new one would hide the transforms of the last; null: none.
  std::unique_ptr<tf2_ros::StaticTransformBroadcaster> mount_broadcaster_;
  SensorMount laser_mount_;
  SensorMount camera_mount_;
  TimeGuard time_guard_;
  BusyTime fusion_time_;
  std::string camera_info_text_;  ///< the intrinsics in use, to notice others

  std::optional<FusedModel> to_draw_;  ///< of the last image, until its match has come

  ros::Publisher model_publisher_;
  ros::Publisher edges_publisher_;
  image_transport::Publisher picture_publisher_;
  ros::Subscriber scan_subscriber_;
  ros::Subscriber camera_info_subscriber_;
  ros::Subscriber compressed_subscriber_;
  image_transport::Subscriber image_subscriber_;
  ros::Subscriber match_subscriber_;
  std::unique_ptr<OdometryFeed> odometry_;
  WakeUp wake_up_;
  LiveParameters live_parameters_;
};

}  // namespace scan_image_slam
