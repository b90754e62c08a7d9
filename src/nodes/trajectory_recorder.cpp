// Writes what a live run has estimated, and the truth if there is one, as TUM files when it is shut
// down: FOLDER/online.tum, encoder.tum, truth.tum; and how often poses came.

#include "scan_image_slam/core/evaluation/trajectory.h"
#include "scan_image_slam/ros/sensor_conversions.h"
#include "scan_image_slam/ros/slam_messages.h"
#include <scan_image_slam/ScanMatch.h>

#include <filesystem>
#include <functional>
#include <iostream>
#include <stdexcept>
#include <string>

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <ros/ros.h>

namespace {

using scan_image_slam::FromMessage;
using scan_image_slam::Seconds;
using scan_image_slam::StampedPose;
using scan_image_slam::ToPose2;
using scan_image_slam::ToStamp;
using scan_image_slam::Trajectory;

StampedPose ToStampedPose(const std_msgs::Header& header, const geometry_msgs::Pose& pose) {
  return {ToStamp(header.stamp), ToPose2(pose)};
}

/// Adds a pose if its time advances, as the files demand. One that is none is told and left out.
void Add(const std::function<StampedPose()>& read, const std::string& topic,
         Trajectory* trajectory) {
  try {
    const StampedPose pose = read();
    if (trajectory->empty() || pose.stamp > trajectory->back().stamp) trajectory->push_back(pose);
  } catch (const std::invalid_argument& error) {
    ROS_WARN_STREAM_THROTTLE(5.0, topic << ": " << error.what());
  }
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "trajectory_recorder");
  ros::NodeHandle node;
  const std::string folder = ros::NodeHandle("~").param<std::string>("folder", ".");
  Trajectory estimate;
  Trajectory encoder;
  Trajectory truth;
  constexpr std::uint32_t kQueue = 1000;
  const ros::Subscriber poses = node.subscribe<geometry_msgs::PoseWithCovarianceStamped>(
      "pose", kQueue, [&](const geometry_msgs::PoseWithCovarianceStampedConstPtr& message) {
        Add([&] { return ToStampedPose(message->header, message->pose.pose); }, "pose", &estimate);
      });
  const ros::Subscriber matches = node.subscribe<scan_image_slam::ScanMatch>(
      "scan_match", kQueue, [&](const scan_image_slam::ScanMatchConstPtr& message) {
        if (!message->has_odometry) return;
        const auto read = [&] {
          const scan_image_slam::MatchedMotion match = FromMessage(*message);
          return StampedPose{match.stamp, *match.odom_from_base};
        };
        Add(read, "scan_match", &encoder);
      });
  const ros::Subscriber truths = node.subscribe<geometry_msgs::PoseStamped>(
      "ground_truth", kQueue, [&](const geometry_msgs::PoseStampedConstPtr& message) {
        Add([&] { return ToStampedPose(message->header, message->pose); }, "ground_truth", &truth);
      });
  ros::spin();
  try {
    std::filesystem::create_directories(folder);
    scan_image_slam::WriteTumFile(folder + "/online.tum", estimate);
    scan_image_slam::WriteTumFile(folder + "/encoder.tum", encoder);
    if (!truth.empty()) scan_image_slam::WriteTumFile(folder + "/truth.tum", truth);
  } catch (const std::exception& error) {
    std::cerr << "trajectory_recorder: " << error.what() << "\n";
    return 1;
  }
  if (estimate.size() > 1) {
    const double seconds = Seconds(estimate.back().stamp - estimate.front().stamp);
    std::cout << "poses=" << estimate.size() << " seconds=" << seconds
              << " poses_per_second=" << static_cast<double>(estimate.size() - 1) / seconds << "\n";
  }
  return 0;
}
