#pragma once

#include "scan_image_slam/core/config/node_options.h"
#include "scan_image_slam/core/geometry/pose2.h"

#include <mutex>
#include <string>

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>
#include <tf2_ros/transform_broadcaster.h>

namespace scan_image_slam {

/// Publishes where the robot's frames are in the map, at its own pace and from a thread of its own:
/// others must never wait for it while a map is drawn. Stamps are a little ahead of time.
class TransformPublisher {
 public:
  TransformPublisher(ros::NodeHandle node, const MapperNodeOptions& options);
  ~TransformPublisher();

  /// Takes over the period and the delay, and nothing else.
  void SetTiming(const MapperNodeOptions& options);

  /// From now on `map_frame` -> `child`, e.g. the odometry's frame.
  void Set(const std::string& child, const Pose2& map_from_child);
  /// Nothing until the next call of Set: nobody knows where the robot is.
  void Stop() { Set("", Pose2()); }

 private:
  void Publish();

  MapperNodeOptions options_;
  std::mutex mutex_;
  std::string child_;
  Pose2 map_from_child_;
  ros::Time last_stamp_;
  tf2_ros::TransformBroadcaster broadcaster_;
  ros::CallbackQueue queue_;
  ros::AsyncSpinner spinner_;
  ros::WallTimer timer_;
};

}  // namespace scan_image_slam
