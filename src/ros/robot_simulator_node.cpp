#include "scan_image_slam/ros/robot_simulator_node.h"

#include "scan_image_slam/ros/package_files.h"
#include "scan_image_slam/ros/simulation_messages.h"

#include <filesystem>
#include <stdexcept>
#include <utility>
#include <variant>
#include <vector>

#include <ros/console.h>
#include <std_msgs/Bool.h>

namespace scan_image_slam {
namespace {

constexpr double kStep = 0.002;          // of the simulation in real time [s]
constexpr double kCommandTimeout = 0.5;  // a robot that is told nothing any more stops [s]
constexpr std::uint32_t kSensorQueue = 10;

template <typename Message>
Message WithFrame(Message message, const std::string& prefix) {
  message.header.frame_id.insert(0, prefix);
  return message;
}

template <typename Message>
Message WithFrames(Message message, const std::string& prefix) {
  message.child_frame_id.insert(0, prefix);
  return WithFrame(std::move(message), prefix);
}

}  // namespace

RobotSimulatorNode::RobotSimulatorNode(ros::NodeHandle node, ros::NodeHandle private_node)
    : frame_prefix_(private_node.param<std::string>("frame_prefix", "")) {
  const auto world = private_node.param<std::string>("world", "laboratory");
  SimulationOptions options;
  options.seed = static_cast<std::uint64_t>(private_node.param("seed", 1));
  options.path = private_node.param<std::string>("path", "");
  options.rounds = private_node.param("rounds", 1);
  if (options.rounds < 1) throw std::invalid_argument("robot_simulator/rounds: must be at least 1");
  options.images = private_node.param("images", true);
  options.ideal = !private_node.param("noise", true);
  options.follow_path = private_node.param("follow_path", true);
  options.start = static_cast<Stamp>(ros::Time::now().toNSec());
  simulation_ = std::make_unique<RobotSimulation>(LoadScenario(FindWorld(world)), options);
  camera_info_ = WithFrame(ToMessage(simulation_->camera_lens(), options.start), frame_prefix_);

  scan_publisher_ = node.advertise<sensor_msgs::LaserScan>("scan", kSensorQueue);
  odom_publisher_ = node.advertise<nav_msgs::Odometry>("odom", kSensorQueue);
  truth_publisher_ = node.advertise<geometry_msgs::PoseStamped>("ground_truth", kSensorQueue);
  finished_publisher_ = node.advertise<std_msgs::Bool>("simulation_finished", 1, true);
  if (options.images) {
    camera_info_publisher_ = node.advertise<sensor_msgs::CameraInfo>("camera_info", kSensorQueue);
    image_publisher_ = image_transport::ImageTransport(node).advertise("image_raw", 2);
  }
  std::vector<geometry_msgs::TransformStamped> mounts;
  for (const auto& mount : StaticTransforms(*simulation_, options.start).transforms) {
    mounts.push_back(WithFrames(mount, frame_prefix_));
  }
  static_transforms_.sendTransform(mounts);
  command_subscriber_ = node.subscribe("cmd_vel", 1, &RobotSimulatorNode::OnCommand, this);
  timer_ = node.createWallTimer(ros::WallDuration(kStep),
                                [this](const ros::WallTimerEvent&) { OnTimer(); });
}

void RobotSimulatorNode::OnTimer() {
  if (!last_command_.isZero() && (ros::WallTime::now() - last_command_).toSec() > kCommandTimeout) {
    simulation_->Drive({0.0, 0.0});
  }
  const auto now = static_cast<Stamp>(ros::Time::now().toNSec());
  for (const SensorEvent& event : simulation_->Advance(now)) {
    std::visit([this](const auto& data) { Publish(data); }, event.data);
  }
  if (finished_ || !simulation_->finished()) return;
  finished_ = true;
  ROS_INFO("the path is driven");
  std_msgs::Bool message;
  message.data = true;
  finished_publisher_.publish(message);
}

void RobotSimulatorNode::OnCommand(const geometry_msgs::TwistConstPtr& message) {
  last_command_ = ros::WallTime::now();
  simulation_->Drive({message->linear.x, message->angular.z});
}

void RobotSimulatorNode::Publish(const LaserScan& scan) {
  scan_publisher_.publish(
      WithFrame(ToMessage(scan, simulation_->scenario().laser.Period()), frame_prefix_));
}

void RobotSimulatorNode::Publish(const CameraFrame& frame) {
  const sensor_msgs::Image image = WithFrame(ToMessage(frame), frame_prefix_);
  camera_info_.header.stamp = image.header.stamp;
  camera_info_publisher_.publish(camera_info_);
  image_publisher_.publish(image);
}

void RobotSimulatorNode::Publish(const OdometryReading& reading) {
  odom_publisher_.publish(WithFrames(ToMessage(reading), frame_prefix_));
  transforms_.sendTransform(WithFrames(ToTransform(reading), frame_prefix_));
}

void RobotSimulatorNode::Publish(const GroundTruth& truth) {
  truth_publisher_.publish(ToMessage(truth));
}

}  // namespace scan_image_slam
