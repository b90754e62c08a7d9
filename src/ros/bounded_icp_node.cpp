#include "scan_image_slam/ros/bounded_icp_node.h"

#include "scan_image_slam/core/recording/number_text.h"
#include "scan_image_slam/ros/node_parameters.h"
#include "scan_image_slam/ros/publish_shared.h"
#include "scan_image_slam/ros/sensor_conversions.h"
#include "scan_image_slam/ros/slam_messages.h"
#include <scan_image_slam/ScanMatch.h>

#include <cmath>
#include <stdexcept>
#include <utility>

#include <ros/console.h>
#include <visualization_msgs/MarkerArray.h>

namespace scan_image_slam {
namespace {

constexpr std::size_t kMaxWaitingModels = 20;

const char* StatusText(MatchStatus status) {
  switch (status) {
    case MatchStatus::kFirst:
      return "first scan";
    case MatchStatus::kMatched:
      return "matched";
    case MatchStatus::kOnWindowEdge:
      return "on window edge: the encoders are more wrong than the window allows";
    case MatchStatus::kDegenerate:
      return "degenerate: one direction is left to the prediction, as in a plain corridor";
    case MatchStatus::kTooFewPoints:
      return "too few points: the prediction is kept";
  }
  return "unknown";
}

}  // namespace

BoundedIcpNode::Options BoundedIcpNode::ReadOptions(const ros::NodeHandle& private_node) {
  Options options;
  ParameterSet set = options.Parameters();
  ReadParameters(private_node, &set);
  return options;
}

BoundedIcpNode::BoundedIcpNode(ros::NodeHandle node, ros::NodeHandle private_node)
    : options_(ReadOptions(private_node)),
      bounded_icp_(options_.bounded_icp),
      gate_(options_.node.odometry.max_wait, kMaxWaitingModels,
            options_.node.odometry.source != OdometrySource::kNone),
      watch_(node, private_node),
      tf_listener_(tf_, node),
      wake_up_(node, [this] { ReleaseModels(); }),
      live_parameters_(private_node, Options().Parameters(), options_.Parameters(),
                       [this](const LiveParameters::Values& values) { Take(values); }) {
  match_publisher_ = node.advertise<ScanMatch>("scan_match", kModelQueue);
  window_publisher_ = node.advertise<visualization_msgs::MarkerArray>("search_window", 1);
  odometry_ = std::make_unique<OdometryFeed>(
      node, options_.node.odometry, &tf_, &watch_,
      [this](Stamp stamp, const Pose2& pose) { OnOdometry(stamp, pose); });
  command_subscriber_ = node.subscribe("syscommand", 1, &BoundedIcpNode::OnCommand, this);
  model_subscriber_ = node.subscribe("icp_model", kModelQueue, &BoundedIcpNode::OnModel, this,
                                     ros::TransportHints().tcpNoDelay());
  watch_.Expect(model_subscriber_, "scan_image_slam/IcpModel", false);
  watch_.AddValue("last match", [this] { return StatusText(last_match_.status); });
  watch_.AddValue("mode", [this] { return ModeName(Mode()); });
  watch_.AddValue("matches", [this] { return std::to_string(matches_); });
  watch_.AddValue("window edge hits", [this] { return std::to_string(window_edge_hits_); });
  watch_.AddValue("encoder scale",
                  [this] { return NumberText(bounded_icp_.learned().encoder_scale, 4); });
  watch_.AddValue("camera yaw correction [deg]",
                  [this] { return NumberText(Degrees(bounded_icp_.learned().camera_yaw), 2); });
  watch_.AddValue("residuals, rms [m]", [this] { return NumberText(last_match_.rms, 4); });
  watch_.AddValue("points matched", [this] {
    return std::to_string(last_match_.matched) + " of " + std::to_string(last_match_.points);
  });
  watch_.AddValue("match [ms]", [this] { return match_time_.Text(); });
  watch_.AddValue("models dropped", [this] { return std::to_string(gate_.dropped()); });
}

/// A user has changed parameters: they count from the next model on.
void BoundedIcpNode::Take(const LiveParameters::Values& values) {
  Options options = options_;
  options.Parameters().Set(values);
  bounded_icp_.SetOptions(options.bounded_icp);
  gate_.set_max_wait(options.node.odometry.max_wait);
  options_ = options;
}

void BoundedIcpNode::OnOdometry(Stamp stamp, const Pose2& odom_from_base) {
  bounded_icp_.AddOdometry(stamp, odom_from_base);
  ReleaseModels();
}

void BoundedIcpNode::OnCommand(const std_msgs::StringConstPtr& message) {
  if (message->data != "reset") return;
  ROS_WARN("reset by command: starting over");
  bounded_icp_.BeginAnew();
  odd_since_.reset();
}

void BoundedIcpNode::StartOver() {
  ROS_WARN("time went back: starting over");
  bounded_icp_.Reset();
  gate_.Clear();
  odd_since_.reset();
}

void BoundedIcpNode::OnModel(const ros::MessageEvent<const IcpModel>& event) {
  const std::string topic = model_subscriber_.getTopic();
  const IcpModelConstPtr& message = event.getConstMessage();
  watch_.Arrived(topic, message->header.stamp.toNSec(), message->header.seq);
  if (!watch_.InTime(topic, event.getReceiptTime())) return;
  try {
    FusedModel model = FromMessage(*message);
    switch (time_guard_.Check(model.stamp, ClockNow(), ros::Time::isSimTime())) {
      case TimeGuard::Verdict::kStale:
        throw std::invalid_argument("its stamp is not later than that of the model before");
      case TimeGuard::Verdict::kAhead:
        throw std::invalid_argument(
            "its stamp leaps ahead of the clock: set the clock of the machine it comes from");
      case TimeGuard::Verdict::kRestarts:
        StartOver();
        break;
      case TimeGuard::Verdict::kAdvances:
        break;
    }
    const Stamp stamp = model.stamp;
    gate_.Push(std::move(model), stamp, SteadyNow());
    ReleaseModels();
  } catch (const std::invalid_argument& error) {
    watch_.Refuse(topic, error.what());
  }
}

void BoundedIcpNode::ReleaseModels() {
  while (const auto model = gate_.Pop(SteadyNow(), bounded_icp_.odometry())) {
    Publish(match_time_.Measure([&] { return bounded_icp_.Match(*model); }));
  }
  // The next one is looked at again when its time is up, though nothing arrives.
  wake_up_.In(gate_.TimeLeft(SteadyNow()));
}

void BoundedIcpNode::Publish(const MatchedMotion& match) {
  last_match_ = match;
  matched_ = ros::WallTime::now();
  ++matches_;
  if (match.status == MatchStatus::kOnWindowEdge) ++window_edge_hits_;
  CheckMatching();
  CheckCalibration();
  PublishShared(match_publisher_, ToMessage(match, options_.node.odometry.base_frame));
  if (window_publisher_.getNumSubscribers() > 0) PublishWindow(match);
}

/// Without scans the pose rests on what else there is.
MatchMode BoundedIcpNode::Mode() const {
  const bool gap = (ros::WallTime::now() - matched_).toSec() > kLaserGap;
  return gap ? MatchMode::kCoasting : last_match_.mode;
}

/// A moment is nothing to be told; it is if it lasts.
void BoundedIcpNode::CheckMatching() {
  constexpr double kPatience = 1.0;  // [s]
  const MatchStatus status = last_match_.status;
  const bool odd = status == MatchStatus::kOnWindowEdge || status == MatchStatus::kTooFewPoints;
  if (!odd) odd_since_.reset();
  if (odd && !odd_since_) odd_since_ = last_match_.stamp;
  const bool lasts = odd && Seconds(last_match_.stamp - *odd_since_) > kPatience;
  const char* advice = status == MatchStatus::kTooFewPoints
                           ? "; is the laser covered, or is everything out of its range?"
                           : "; a wheel may slip, or window/ is too narrow for these encoders";
  watch_.SetProblem("matching", lasts ? StatusText(status) + std::string(advice) : "");
}

/// Small errors of the camera's yaw are made up for; it is told if they are large and certain.
void BoundedIcpNode::CheckCalibration() {
  constexpr double kTolerated = 0.3;  // [deg]
  // Standard deviation [deg]. In the first metres of a room edges that are not on the surface
  // behind them deceive it by more than it says.
  constexpr double kCertain = 0.04;
  const LearnedCalibration learned = bounded_icp_.learned();
  const double yaw = Degrees(learned.camera_yaw);
  const bool off = std::abs(yaw) > kTolerated && Degrees(learned.camera_yaw_stddev) < kCertain;
  const auto text = [&] {
    return "the camera looks " + NumberText(std::abs(yaw), 1) + " deg farther to the " +
           (yaw > 0.0 ? "left" : "right") +
           " than its transform says: mend that, calibrate_camera_laser finds the values";
  };
  watch_.SetProblem("camera yaw", off ? text() : "");
}

/// The window around the prediction, magnified so that it can be seen, and where the result lies.
void BoundedIcpNode::PublishWindow(const MatchedMotion& match) {
  constexpr double kMagnification = 10.0;
  visualization_msgs::Marker marker;
  marker.header.stamp = ToRosTime(match.stamp);
  marker.header.frame_id = options_.node.odometry.base_frame;
  marker.ns = "window_x10";
  marker.type = visualization_msgs::Marker::LINE_STRIP;
  marker.scale.x = 0.01;
  marker.pose.orientation.w = 1.0;
  marker.color.a = 1.0f;
  marker.color.r = match.status == MatchStatus::kOnWindowEdge ? 1.0f : 0.2f;
  marker.color.g = 0.8f;
  const double d = kMagnification * match.window.half_distance;
  const double half_angle = std::min(M_PI, kMagnification * match.window.half_angle);
  constexpr int kSteps = 16;
  for (int i = -kSteps; i <= kSteps; ++i) {
    geometry_msgs::Point point;
    point.x = d * std::cos(half_angle * i / kSteps);
    point.y = d * std::sin(half_angle * i / kSteps);
    marker.points.push_back(point);
  }
  visualization_msgs::Marker result = marker;
  result.ns = "deviation_x10";
  result.type = visualization_msgs::Marker::ARROW;
  result.points.clear();
  result.pose.position.x = kMagnification * match.deviation.distance;
  result.pose.position.y = kMagnification * match.deviation.lateral;
  result.pose.orientation.z = std::sin(kMagnification * match.deviation.angle / 2.0);
  result.pose.orientation.w = std::cos(kMagnification * match.deviation.angle / 2.0);
  result.scale.x = 0.3;
  result.scale.y = 0.03;
  result.scale.z = 0.03;
  visualization_msgs::MarkerArray array;
  array.markers = {marker, result};
  PublishShared(window_publisher_, std::move(array));
}

}  // namespace scan_image_slam
