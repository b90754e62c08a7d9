// Passes recorded transforms on, without those that place the odometry's frame: a recording may
// hold the map -> odom of another program, and a frame can have only one parent.

#include "scan_image_slam/ros/sensor_conversions.h"

#include <string>

#include <ros/ros.h>
#include <tf2_msgs/TFMessage.h>

int main(int argc, char** argv) {
  ros::init(argc, argv, "transform_filter");
  ros::NodeHandle node;
  const std::string odom_frame = ros::NodeHandle("~").param<std::string>("odom_frame", "odom");
  const ros::Publisher publisher = node.advertise<tf2_msgs::TFMessage>("tf", 100);
  const ros::Subscriber subscriber = node.subscribe<tf2_msgs::TFMessage>(
      "tf_recorded", 100, [&](const tf2_msgs::TFMessageConstPtr& message) {
        tf2_msgs::TFMessage passed;
        for (const geometry_msgs::TransformStamped& transform : message->transforms) {
          if (scan_image_slam::StripSlash(transform.child_frame_id) == odom_frame) continue;
          passed.transforms.push_back(transform);
        }
        if (!passed.transforms.empty()) publisher.publish(passed);
      });
  ros::spin();
  return 0;
}
