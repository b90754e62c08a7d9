#pragma once

#include "scan_image_slam/core/geometry/pose2.h"
#include "scan_image_slam/core/sensor/stamp.h"

#include <string>

#include <nav_msgs/Path.h>
#include <ros/node_handle.h>

namespace scan_image_slam {

/// A path that grows with the robot's way. Its length is bounded: a path of more than 20000 poses
/// is thinned to half and grows on with twice the spacing.
class PathPublisher {
 public:
  PathPublisher(ros::NodeHandle node, const std::string& topic, std::string frame, double spacing);

  void Add(Stamp stamp, const Pose2& pose);
  /// Publishes the path if it has grown and somebody listens.
  void Publish();
  void Clear();

 private:
  double spacing_;
  ros::Publisher publisher_;
  nav_msgs::Path path_;
  Pose2 last_;
  bool grown_ = false;
};

}  // namespace scan_image_slam
