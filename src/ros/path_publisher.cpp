#include "scan_image_slam/ros/path_publisher.h"

#include "scan_image_slam/ros/publish_shared.h"
#include "scan_image_slam/ros/sensor_conversions.h"
#include "scan_image_slam/ros/slam_messages.h"

#include <utility>

namespace scan_image_slam {

PathPublisher::PathPublisher(ros::NodeHandle node, const std::string& topic, std::string frame,
                             double spacing)
    : spacing_(spacing), publisher_(node.advertise<nav_msgs::Path>(topic, 1, true)) {
  path_.header.frame_id = std::move(frame);
}

void PathPublisher::Add(Stamp stamp, const Pose2& pose) {
  constexpr std::size_t kMaxPoses = 20000;
  if (!path_.poses.empty() && (pose.translation() - last_.translation()).norm() < spacing_) return;
  if (path_.poses.size() >= kMaxPoses) {
    std::vector<geometry_msgs::PoseStamped> thinned;
    for (std::size_t i = 0; i < path_.poses.size(); i += 2) thinned.push_back(path_.poses[i]);
    path_.poses = std::move(thinned);
    spacing_ *= 2.0;
  }
  geometry_msgs::PoseStamped message;
  message.header.stamp = ToRosTime(stamp);
  message.header.frame_id = path_.header.frame_id;
  message.pose = ToPoseMessage(pose);
  path_.poses.push_back(message);
  path_.header.stamp = message.header.stamp;
  last_ = pose;
  grown_ = true;
}

void PathPublisher::Publish() {
  if (!grown_) return;
  PublishShared(publisher_, path_);
  grown_ = false;
}

void PathPublisher::Clear() {
  path_.poses.clear();
  grown_ = true;
}

}  // namespace scan_image_slam
