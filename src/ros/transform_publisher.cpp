#include "scan_image_slam/ros/transform_publisher.h"

#include "scan_image_slam/ros/slam_messages.h"

namespace scan_image_slam {

TransformPublisher::TransformPublisher(ros::NodeHandle node, const MapperNodeOptions& options)
    : options_(options), spinner_(1, &queue_) {
  node.setCallbackQueue(&queue_);
  if (!options_.pub_map_odom_transform) return;
  timer_ = node.createWallTimer(ros::WallDuration(options_.transform_publish_period),
                                [this](const ros::WallTimerEvent&) { Publish(); });
  spinner_.start();
}

TransformPublisher::~TransformPublisher() { spinner_.stop(); }

void TransformPublisher::SetTiming(const MapperNodeOptions& options) {
  const std::lock_guard<std::mutex> lock(mutex_);
  options_.tf_delay = options.tf_delay;
  timer_.setPeriod(ros::WallDuration(options.transform_publish_period));
}

void TransformPublisher::Set(const std::string& child, const Pose2& map_from_child) {
  const std::lock_guard<std::mutex> lock(mutex_);
  child_ = child;
  map_from_child_ = map_from_child;
}

void TransformPublisher::Publish() {
  geometry_msgs::TransformStamped transform;
  ros::Duration delay;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (child_.empty()) return;
    transform.header.frame_id = options_.map_frame;
    transform.child_frame_id = child_;
    transform.transform = ToTransformMessage(map_from_child_);
    delay.fromSec(options_.tf_delay);
  }
  const ros::Time now = ros::Time::now();
  if (now.isZero()) return;  // simulated time has not begun
  transform.header.stamp = now + delay;
  // While simulated time stands still there is nothing new to say.
  if (transform.header.stamp == last_stamp_) return;
  last_stamp_ = transform.header.stamp;
  broadcaster_.sendTransform(transform);
}

}  // namespace scan_image_slam
