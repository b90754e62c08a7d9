#include "scan_image_slam/ros/mapper_node.h"

#include "scan_image_slam/ros/graph_markers.h"
#include "scan_image_slam/ros/node_parameters.h"
#include "scan_image_slam/ros/publish_shared.h"
#include "scan_image_slam/ros/sensor_conversions.h"
#include "scan_image_slam/ros/slam_messages.h"

#include <cmath>
#include <stdexcept>
#include <utility>

#include <ros/console.h>
#include <std_msgs/String.h>
#include <visualization_msgs/MarkerArray.h>

namespace scan_image_slam {
namespace {

constexpr std::uint32_t kMatchQueue = 40;
constexpr int kMaxWaiting = 20;  // jobs of the back-end, before the robot is looked for again
constexpr char kMapProblem[] = "map";

}  // namespace

MapperNode::Options MapperNode::ReadOptions(const ros::NodeHandle& private_node) {
  Options options;
  ParameterSet set = options.Parameters();
  ReadParameters(private_node, &set);
  return options;
}

MapperNode::MapperNode(ros::NodeHandle node, ros::NodeHandle private_node)
    : options_(ReadOptions(private_node)),
      mapper_(options_.mapper),
      back_end_(options_.loop_closer),
      watch_(node, private_node),
      transform_publisher_(node, options_.node),
      map_publisher_(node, options_.node.map_frame),
      trajectory_(node, "trajectory", options_.node.map_frame, options_.node.trajectory_spacing),
      encoder_trajectory_(node, "encoder_trajectory", options_.node.map_frame,
                          options_.node.trajectory_spacing),
      pairs_(kMatchQueue),
      live_parameters_(private_node, Options().Parameters(), options_.Parameters(),
                       [this](const LiveParameters::Values& values) { Take(values); }),
      files_(node) {
  pose_publisher_ = node.advertise<geometry_msgs::PoseWithCovarianceStamped>("pose", kMatchQueue);
  command_publisher_ = node.advertise<std_msgs::String>("syscommand", 1);
  graph_publisher_ = node.advertise<visualization_msgs::MarkerArray>("pose_graph", 1, true);
  get_map_service_ = node.advertiseService("dynamic_map", &MapperNode::GetMap, this);
  reset_service_ = node.advertiseService("reset", &MapperNode::Reset, this);
  pause_service_ = node.advertiseService("pause", &MapperNode::Pause, this);
  watch_.AddValue("mode", [this] {
    return mapper_.lost() ? "lost" : mapper_.growing() ? "mapping" : "localization";
  });
  watch_.AddValue("drawing [ms]", [this] { return map_time_.Text(); });
  watch_.AddValue("waiting for the back-end",
                  [this] { return std::to_string(back_end_.waiting()); });
  watch_.AddValue("paused", [this] { return paused_ ? "yes" : "no"; });
  watch_.AddValue("agreement with the loaded map", [this] { return std::to_string(agreement_); });
  StartWithStateFile(node);
  AdvertiseFileServices();

  const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
  initial_pose_subscriber_ = node.subscribe("initialpose", 1, &MapperNode::OnInitialPose, this);
  match_subscriber_ = node.subscribe("scan_match", kMatchQueue, &MapperNode::OnMatch, this, hints);
  watch_.Expect(match_subscriber_, "scan_image_slam/ScanMatch", false);
  paired_model_subscriber_.subscribe(node, "icp_model", kMatchQueue, hints);
  paired_match_subscriber_.subscribe(node, "scan_match", kMatchQueue, hints);
  pairs_.connectInput(paired_model_subscriber_, paired_match_subscriber_);
  pairs_.registerCallback(&MapperNode::OnMatchedModel, this);
  map_timer_ = node.createWallTimer(ros::WallDuration(options_.node.map_update_interval),
                                    [this](const ros::WallTimerEvent&) { PublishMap(); });
}

/// A user has changed parameters: they count from the next match on.
void MapperNode::Take(const LiveParameters::Values& values) {
  Options options = options_;
  options.Parameters().Set(values);
  mapper_.SetOptions(options.mapper);
  back_end_.SetOptions(options.loop_closer);
  transform_publisher_.SetTiming(options.node);
  map_timer_.setPeriod(ros::WallDuration(options.node.map_update_interval));
  options_ = options;
}

void MapperNode::OnMatch(const ScanMatchConstPtr& message) {
  watch_.Arrived(match_subscriber_.getTopic(), message->header.stamp.toNSec(), message->header.seq);
  try {
    ApplyNews();
    const MatchedMotion match = FromMessage(*message);
    if (last_pose_ && match.stamp < last_pose_->stamp) TakeTimeBack();
    PublishPose(mapper_.AddMatch(match));
    if (match.odom_from_base) encoder_trajectory_.Add(match.stamp, *match.odom_from_base);
  } catch (const std::invalid_argument& error) {
    watch_.Refuse(match_subscriber_.getTopic(), error.what());
  }
}

/// A bag is played again, or the clock was set.
void MapperNode::TakeTimeBack() {
  if (ros::Time::isSimTime()) {
    ROS_WARN("time went back: starting over");
    mapper_.TimeWentBack();
    StartOver();
  } else {
    ROS_WARN("the clock was set back: going on from the last pose");
    mapper_.ClockWasSet();
  }
}

void MapperNode::PublishPose(const MapPose& pose) {
  last_pose_ = pose;
  watch_.SetProblem("location", pose.lost ? "the robot has not been found in the loaded map: drive "
                                            "on, or tell where it is by initialpose"
                                          : "");
  if (pose.lost) {
    transform_publisher_.Stop();
    return;
  }
  PublishShared(pose_publisher_, ToMessage(pose, options_.node.map_frame));
  trajectory_.Add(pose.stamp, pose.map_from_base);
  if (pose.map_from_odom) {
    has_encoders_ = true;
    transform_publisher_.Set(options_.node.odom_frame, *pose.map_from_odom);
  } else if (!has_encoders_ && EncodersAreMissing(pose.stamp)) {
    transform_publisher_.Set(options_.node.base_frame, pose.map_from_base);
  }
}

bool MapperNode::EncodersAreMissing(Stamp stamp) {
  constexpr double kPatience = 1.0;  // with odometry that is connected after the laser [s]
  if (!without_encoders_since_) without_encoders_since_ = stamp;
  return std::fabs(Seconds(stamp - *without_encoders_since_)) >= kPatience;
}

/// Poses are told of every match; what is drawn can wait for the robot to pass there again.
void MapperNode::OnMatchedModel(const IcpModelConstPtr& model,
                                const ros::MessageEvent<const ScanMatch>& match) {
  if (paused_ && mapper_.growing()) return;
  if (!watch_.InTime(match_subscriber_.getTopic(), match.getReceiptTime())) return;
  try {
    const FusedModel scan = FromMessage(*model);
    const MatchedMotion motion = FromMessage(*match.getConstMessage());
    if (const auto keyframe = Draw(scan, motion)) back_end_.Add(keyframe);
    changed_ = changed_ || mapper_.growing();
    if (back_end_.waiting() >= kMaxWaiting) return;
    if (auto sighting = mapper_.Look(scan, motion)) back_end_.Look(std::move(*sighting));
  } catch (const std::invalid_argument& error) {
    watch_.Refuse(paired_model_subscriber_.getTopic(), error.what());
  }
}

std::shared_ptr<const Keyframe> MapperNode::Draw(const FusedModel& model,
                                                 const MatchedMotion& match) {
  try {
    auto keyframe = map_time_.Measure([&] { return mapper_.AddModel(model, match); });
    watch_.SetProblem(kMapProblem, "");
    return keyframe;
  } catch (const std::invalid_argument& error) {
    watch_.SetProblem(kMapProblem, std::string("scans are left out, as ") + error.what() +
                                       "; raise it, or lower map_max_range");
    throw;
  }
}

void MapperNode::OnInitialPose(const geometry_msgs::PoseWithCovarianceStampedConstPtr& message) {
  const std::string topic = initial_pose_subscriber_.getTopic();
  if (StripSlash(message->header.frame_id) != StripSlash(options_.node.map_frame)) {
    watch_.Refuse(topic, "its frame is " + message->header.frame_id + ", expected is " +
                             options_.node.map_frame);
    return;
  }
  try {
    mapper_.SetPose(ToPose2(message->pose.pose));
    ROS_INFO_STREAM("the pose was set by " << topic);
  } catch (const std::invalid_argument& error) {
    watch_.Refuse(topic, error.what());
  }
}

/// Takes in what the back-end has found, and a little of the drawing that follows from it.
void MapperNode::ApplyNews() {
  constexpr int kScansAtOnce = 4;
  try {
    mapper_.Redraw(kScansAtOnce);
  } catch (const std::invalid_argument& error) {  // that scan stays where it is; the pose goes on
    watch_.Refuse(paired_model_subscriber_.getTopic(), error.what());
  }
  BackEndNews news = back_end_.Take();
  if (news.location) ApplyLocation(*news.location);
  if (!news.graph) return;
  mapper_.Correct(news.graph->poses, news.graph->let_go);
  graph_ = std::move(news.graph);
  trajectory_moved_ = true;
  changed_ = true;
}

void MapperNode::ApplyLocation(const Location& location) {
  const bool was_lost = mapper_.lost();
  mapper_.Locate(location);
  agreement_ = location.agreement;
  if (was_lost && !mapper_.lost()) {
    ROS_INFO_STREAM("the robot was found in the loaded map, agreement " << agreement_);
  } else if (!was_lost && mapper_.lost()) {
    ROS_WARN_STREAM("the robot is not where it was thought to be in the loaded map, agreement "
                    << agreement_ << ": looking for it");
    ResetMatching();  // its surroundings are others
  }
}

void MapperNode::PublishMap() {
  if (std::exchange(trajectory_moved_, false)) {
    trajectory_.Clear();
    for (const MapPose& pose : mapper_.Trajectory()) {
      trajectory_.Add(pose.stamp, pose.map_from_base);
    }
  }
  map_publisher_.Publish(&mapper_.grid(), ros::Time::now());
  if (graph_ && graph_publisher_.getNumSubscribers() > 0) {
    PublishShared(graph_publisher_, ToMarkers(*graph_, options_.node.map_frame, ros::Time::now()));
  }
  trajectory_.Publish();
  encoder_trajectory_.Publish();
}

bool MapperNode::GetMap(nav_msgs::GetMap::Request&, nav_msgs::GetMap::Response& response) {
  response.map = map_publisher_.Current(&mapper_.grid(), ros::Time::now());
  return response.map.info.width > 0;
}

bool MapperNode::Reset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  mapper_.Reset();
  StartOver();
  ResetMatching();
  response.success = true;
  response.message = "map and matching start over";
  return true;
}

void MapperNode::ResetMatching() {
  std_msgs::String command;
  command.data = "reset";
  PublishShared(command_publisher_, command);
}

/// Nothing is left of what was told of the map before.
void MapperNode::StartOver() {
  last_pose_.reset();
  graph_.reset();
  trajectory_.Clear();
  encoder_trajectory_.Clear();
  map_publisher_.StartOver();
  watch_.ForgetProblem(kMapProblem);
  if (mapper_.empty()) back_end_.Load(GraphMemory());
  if (mapper_.lost()) transform_publisher_.Stop();
}

bool MapperNode::Pause(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response) {
  paused_ = request.data;
  response.success = true;
  response.message = paused_ ? "the map is left as it is; the pose goes on" : "mapping goes on";
  return true;
}

}  // namespace scan_image_slam
