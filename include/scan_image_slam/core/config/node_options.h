#pragma once

#include <string>

namespace scan_image_slam {

/// Where the poses of the encoders come from.
enum class OdometrySource {
  kAuto,   ///< the topic; TF as long as nothing comes on the topic
  kTopic,  ///< nav_msgs/Odometry only
  kTf,     ///< the transform odom_frame -> base_frame only
  kNone,   ///< no encoders: constant velocity
};

/// Names of frames and where the encoders are read: shared by the nodes that need them.
struct OdometryInput {
  std::string base_frame = "base_link";
  std::string odom_frame = "odom";
  OdometrySource source = OdometrySource::kAuto;
  double max_wait = 0.003;  ///< a scan waits so long for the encoders to reach its stamp [s]
};

/// Pose of a sensor on the robot, if it is not taken from TF: x forward, y left, z up, for a camera
/// the direction it looks at is x.
struct SensorPose {
  bool from_tf = true;
  double x = 0.0;      ///< [m]
  double y = 0.0;      ///< [m]
  double z = 0.0;      ///< [m]
  double roll = 0.0;   ///< [rad]
  double pitch = 0.0;  ///< positive looks down [rad]
  double yaw = 0.0;    ///< [rad]
};

struct ScanImageFusionNodeOptions {
  OdometryInput odometry;
  SensorPose laser;
  SensorPose camera;
  bool publish_mounts = false;  ///< those that are not taken from TF
  bool use_camera = true;
  std::string image_transport = "raw";
};

struct BoundedIcpNodeOptions {
  OdometryInput odometry;
  /// Its scans have waited in scan_image_fusion already.
  BoundedIcpNodeOptions() { odometry.max_wait = 0.002; }
};

struct MapperNodeOptions {
  std::string map_frame = "map";
  std::string odom_frame = "odom";
  std::string base_frame = "base_link";
  bool pub_map_odom_transform = true;
  double transform_publish_period = 0.05;  ///< [s]
  double tf_delay = 0.05;                  ///< transforms are stamped so far ahead [s]
  double map_update_interval = 1.0;        ///< [s]
  double trajectory_spacing = 0.05;        ///< between the poses of the paths [m]
  std::string map_folder = "maps";         ///< the only place that services write to
  std::string state_file;                  ///< map to begin with; empty: none
  bool localization = false;               ///< leave it as it is
  double autosave_period = 0.0;            ///< between two savings of it; 0: none [s]
};

}  // namespace scan_image_slam
