#include "scan_image_slam/ros/mapper_node.h"

#include "scan_image_slam/core/mapping/map_file.h"
#include "scan_image_slam/ros/graph_markers.h"
#include "scan_image_slam/ros/node_parameters.h"
#include "scan_image_slam/ros/publish_shared.h"
#include "scan_image_slam/ros/sensor_conversions.h"
#include "scan_image_slam/ros/slam_messages.h"

#include <filesystem>
#include <stdexcept>
#include <utility>

#include <ros/console.h>
#include <std_msgs/String.h>
#include <visualization_msgs/MarkerArray.h>

namespace scan_image_slam {
namespace {

constexpr std::uint32_t kQueue = 40;

/// The place of a file inside a folder, absolute. Throws std::invalid_argument if it is outside.
std::filesystem::path PathInFolder(const std::string& folder, const std::string& name) {
  namespace fs = std::filesystem;
  if (name.empty()) throw std::invalid_argument("the name of the map is empty");
  const fs::path root = fs::weakly_canonical(fs::absolute(folder));
  fs::path path = fs::weakly_canonical(root / name);
  const fs::path relative = path.lexically_relative(root);
  if (relative.empty() || *relative.begin() == ".." || relative == ".") {
    throw std::invalid_argument(path.string() + " lies outside the folder " + root.string() +
                                " (parameter map_folder of the mapper)");
  }
  return path;
}

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
      loop_closing_(options_.loop_closer),
      watch_(node, private_node),
      transform_publisher_(node, options_.node),
      map_publisher_(node, options_.node.map_frame),
      trajectory_(node, "trajectory", options_.node.map_frame, options_.node.trajectory_spacing),
      encoder_trajectory_(node, "encoder_trajectory", options_.node.map_frame,
                          options_.node.trajectory_spacing),
      pairs_(kQueue),
      live_parameters_(private_node, Options().Parameters(), options_.Parameters(),
                       [this](const LiveParameters::Values& values) { Take(values); }) {
  pose_publisher_ = node.advertise<geometry_msgs::PoseWithCovarianceStamped>("pose", kQueue);
  command_publisher_ = node.advertise<std_msgs::String>("syscommand", 1);
  graph_publisher_ = node.advertise<visualization_msgs::MarkerArray>("pose_graph", 1, true);
  get_map_service_ = node.advertiseService("dynamic_map", &MapperNode::GetMap, this);
  reset_service_ = node.advertiseService("reset", &MapperNode::Reset, this);
  pause_service_ = node.advertiseService("pause", &MapperNode::Pause, this);
  save_map_service_ = node.advertiseService("save_map", &MapperNode::SaveMap, this);

  const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
  initial_pose_subscriber_ = node.subscribe("initialpose", 1, &MapperNode::OnInitialPose, this);
  match_subscriber_ = node.subscribe("scan_match", kQueue, &MapperNode::OnMatch, this, hints);
  watch_.Expect(match_subscriber_, "scan_image_slam/ScanMatch", false);
  paired_model_subscriber_.subscribe(node, "icp_model", kQueue, hints);
  paired_match_subscriber_.subscribe(node, "scan_match", kQueue, hints);
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
  loop_closing_.SetOptions(options.loop_closer);
  transform_publisher_.SetTiming(options.node);
  map_timer_.setPeriod(ros::WallDuration(options.node.map_update_interval));
  options_ = options;
}

void MapperNode::OnMatch(const ScanMatchConstPtr& message) {
  watch_.Arrived(match_subscriber_.getTopic());
  try {
    ApplyLoopClosures();
    const MatchedMotion match = FromMessage(*message);
    if (last_pose_ && match.stamp < last_pose_->stamp) {
      trajectory_.Clear();
      encoder_trajectory_.Clear();
    }
    PublishPose(mapper_.AddMatch(match));
    if (match.odom_from_base) encoder_trajectory_.Add(match.stamp, *match.odom_from_base);
  } catch (const std::invalid_argument& error) {
    watch_.Refuse(match_subscriber_.getTopic(), error.what());
  }
}

void MapperNode::PublishPose(const MapPose& pose) {
  last_pose_ = pose;
  PublishShared(pose_publisher_, ToMessage(pose, options_.node.map_frame));
  trajectory_.Add(pose.stamp, pose.map_from_base);
  if (pose.map_from_odom) {
    has_encoders_ = true;
    transform_publisher_.Set(options_.node.odom_frame, *pose.map_from_odom);
  } else if (!has_encoders_) {
    transform_publisher_.Set(options_.node.base_frame, pose.map_from_base);
  }
}

void MapperNode::OnMatchedModel(const IcpModelConstPtr& model, const ScanMatchConstPtr& match) {
  if (paused_) return;
  try {
    const auto keyframe = mapper_.AddModel(FromMessage(*model), FromMessage(*match));
    if (keyframe) loop_closing_.Add(keyframe);
  } catch (const std::invalid_argument& error) {
    watch_.Refuse(paired_model_subscriber_.getTopic(), error.what());
  }
}

void MapperNode::OnInitialPose(const geometry_msgs::PoseWithCovarianceStampedConstPtr& message) {
  const std::string topic = initial_pose_subscriber_.getTopic();
  if (StripSlash(message->header.frame_id) != options_.node.map_frame) {
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
void MapperNode::ApplyLoopClosures() {
  constexpr int kScansAtOnce = 4;
  mapper_.Redraw(kScansAtOnce);
  std::optional<GraphState> found = loop_closing_.Take();
  if (!found) return;
  mapper_.Correct(found->poses);
  graph_ = std::move(found);
  trajectory_moved_ = true;
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
  last_pose_.reset();
  graph_.reset();
  trajectory_.Clear();
  encoder_trajectory_.Clear();
  std_msgs::String command;
  command.data = "reset";
  PublishShared(command_publisher_, command);
  response.success = true;
  response.message = "map and matching start over";
  return true;
}

bool MapperNode::Pause(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response) {
  paused_ = request.data;
  response.success = true;
  response.message = paused_ ? "the map is left as it is; the pose goes on" : "mapping goes on";
  return true;
}

bool MapperNode::SaveMap(SaveMapRequest& request, SaveMapResponse& response) {
  try {
    const MapImage map = ToMapImage(mapper_.grid());
    if (map.width == 0) throw std::runtime_error("there is no map yet");
    const std::filesystem::path stem = PathInFolder(options_.node.map_folder, request.name);
    std::filesystem::create_directories(stem.parent_path());
    response.path = WriteMap(map, stem.string());
    response.success = true;
  } catch (const std::exception& error) {
    response.success = false;
    response.message = error.what();
    ROS_ERROR_STREAM("save_map: " << error.what());
  }
  return true;
}

}  // namespace scan_image_slam
