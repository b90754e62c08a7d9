#include "scan_image_slam/ros/odometry_feed.h"

#include "scan_image_slam/ros/sensor_conversions.h"
#include "scan_image_slam/ros/sensor_frames.h"

#include <stdexcept>
#include <utility>

#include <tf2/exceptions.h>

namespace scan_image_slam {
namespace {

constexpr double kPollPeriod = 0.01;           // of the transform [s]
constexpr double kTopicSilence = 1.0;          // after which TF is looked at [s]
constexpr double kTransformSilence = 2.0;      // after which it is told [s]
constexpr double kTransformWait = 0.8;         // for that of the encoders' frame to the base [s]
constexpr std::uint32_t kReadingQueue = 1000;  // small; a late node shall hear of all its gap

}  // namespace

OdometryFeed::OdometryFeed(ros::NodeHandle node, const OdometryInput& input,
                           const tf2_ros::Buffer* tf, InputWatch* watch, OnPose on_pose)
    : input_(input),
      tf_(tf),
      watch_(watch),
      on_pose_(std::move(on_pose)),
      by_transform_(input.source == OdometrySource::kTf),
      last_change_(ros::WallTime::now()) {
  if (input_.source == OdometrySource::kAuto || input_.source == OdometrySource::kTopic) {
    subscriber_ = node.subscribe("odom", kReadingQueue, &OdometryFeed::OnOdometry, this,
                                 ros::TransportHints().tcpNoDelay());
    ExpectTopic();
  }
  if (input_.source == OdometrySource::kAuto || input_.source == OdometrySource::kTf) {
    timer_ = node.createWallTimer(ros::WallDuration(kPollPeriod),
                                  [this](const ros::WallTimerEvent&) { PollTransform(); });
  }
}

void OdometryFeed::ExpectTopic() { watch_->Expect(subscriber_, "nav_msgs/Odometry", true); }

void OdometryFeed::OnOdometry(const nav_msgs::OdometryConstPtr& message) {
  if (std::exchange(by_transform_, false)) {
    ExpectTopic();
    watch_->ForgetProblem("encoders");
  }
  watch_->Arrived(subscriber_.getTopic(), message->header.stamp.toNSec());
  last_message_ = ros::WallTime::now();
  if (first_message_.isZero()) first_message_ = last_message_;
  try {
    CheckFrame(StripSlash(message->header.frame_id));
    if (!FindBase(StripSlash(message->child_frame_id))) return;
    on_pose_(ToStamp(message->header.stamp), ToPose2(message->pose.pose) * child_from_base_);
  } catch (const std::invalid_argument& error) {
    watch_->Refuse(subscriber_.getTopic(), error.what());
  }
}

/// Encoders may tell the pose of another of the base's frames, as base_footprint. False: where that
/// is may still come to be known.
bool OdometryFeed::FindBase(const std::string& child) {
  if (child_ == child) return true;
  const std::string base = StripSlash(input_.base_frame);
  FrameLookup base_from_child;
  if (!child.empty()) base_from_child = LookUpOnBase(*tf_, base, child, input_.odom_frame);
  const std::string& problem = base_from_child.problem;
  if (!problem.empty() && (last_message_ - first_message_).toSec() < kTransformWait) return false;
  watch_->SetProblem("base of " + subscriber_.getTopic(),
                     problem.empty() ? "" : problem + "; its poses are taken for those of " + base);
  child_from_base_ = ToPose2(base_from_child.base_from_sensor).Inverse();
  child_ = child;
  return true;
}

void OdometryFeed::CheckFrame(const std::string& frame) {
  const std::string expected = StripSlash(input_.odom_frame);
  const bool right = frame.empty() || frame == expected;
  watch_->SetProblem("frame of " + subscriber_.getTopic(),
                     right ? ""
                           : "it is " + frame + ", but odom_frame is " + expected +
                                 ", which the mapper ties to the map: set odom_frame, or let "
                                 "odom_source be tf");
}

void OdometryFeed::PollTransform() {
  if ((ros::WallTime::now() - last_message_).toSec() < kTopicSilence) return;
  try {
    const geometry_msgs::TransformStamped transform = tf_->lookupTransform(
        StripSlash(input_.odom_frame), StripSlash(input_.base_frame), ros::Time(0));
    if (transform.header.stamp != last_transform_) {
      last_transform_ = transform.header.stamp;
      last_change_ = ros::WallTime::now();
      if (!by_transform_ && last_message_.isZero()) {  // nobody needs the topic
        watch_->Forget(subscriber_.getTopic());
        by_transform_ = true;
      }
      on_pose_(ToStamp(transform.header.stamp), ToPose2(ToIsometry(transform.transform)));
    }
  } catch (const tf2::TransformException&) {
    // Not there yet: the node runs without encoders until it is.
  } catch (const std::invalid_argument& error) {
    watch_->Refuse(input_.odom_frame + " -> " + input_.base_frame, error.what());
  }
  if (by_transform_) WatchTransform();
}

void OdometryFeed::WatchTransform() {
  std::string problem;
  if ((ros::WallTime::now() - last_change_).toSec() > kTransformSilence) {
    problem = LookUpSensor(*tf_, input_.odom_frame, input_.base_frame).problem;
    if (problem.empty()) {
      problem = "no new transform " + input_.odom_frame + " -> " + input_.base_frame + " has come";
    }
    problem += "; until there is one the pose goes on without encoders";
  }
  watch_->SetProblem("encoders", problem);
}

}  // namespace scan_image_slam
