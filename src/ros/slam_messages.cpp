#include "scan_image_slam/ros/slam_messages.h"

#include "scan_image_slam/ros/sensor_conversions.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <stdexcept>

namespace scan_image_slam {
namespace {

constexpr double kFastest = 1000.0;  // velocity of a base [m/s], [rad/s]

/// Throws std::invalid_argument, naming the pose, if it can't be one of a robot.
Pose2 FromPose2D(const geometry_msgs::Pose2D& pose, const std::string& name) {
  if (!IsPlausiblePosition(pose.x, pose.y) || !std::isfinite(pose.theta)) {
    throw std::invalid_argument(name + " is not finite, or out of this world");
  }
  return {pose.x, pose.y, pose.theta};
}

VerticalEdge ToMessage(const ModelEdge& edge) {
  VerticalEdge message;
  message.camera_x = edge.camera.x();
  message.camera_y = edge.camera.y();
  message.bearing = edge.bearing;
  message.bearing_stddev = edge.bearing_stddev;
  message.range = edge.range;
  message.range_stddev = edge.range_stddev;
  message.range_by_bearing = edge.range_by_bearing;
  message.time_offset = edge.time_offset;
  message.sign = static_cast<std::int8_t>(edge.sign);
  message.weight = edge.weight;
  message.contrast = edge.contrast;
  return message;
}

/// Throws std::invalid_argument, naming the thing, unless all numbers are finite.
void RequireFinite(std::initializer_list<double> numbers, const std::string& thing) {
  for (const double number : numbers) {
    if (!std::isfinite(number)) throw std::invalid_argument(thing + " is not finite");
  }
}

/// Throws std::invalid_argument, naming the thing, unless a base may move like that.
Velocity2 PlausibleVelocity(double x, double y, double yaw, const std::string& thing) {
  for (const double velocity : {x, y, yaw}) {
    if (!(std::abs(velocity) <= kFastest)) {
      throw std::invalid_argument(thing + " is not finite, or no robot's");
    }
  }
  return {x, y, yaw};
}

ModelEdge FromMessage(const VerticalEdge& message) {
  RequireFinite({message.camera_x, message.camera_y, message.bearing, message.bearing_stddev,
                 message.range, message.range_stddev, message.range_by_bearing, message.time_offset,
                 message.weight, message.contrast},
                "an edge");
  ModelEdge edge;
  edge.camera = {message.camera_x, message.camera_y};
  edge.bearing = message.bearing;
  edge.bearing_stddev = message.bearing_stddev;
  edge.range = message.range;
  edge.range_stddev = message.range_stddev;
  edge.range_by_bearing = message.range_by_bearing;
  edge.time_offset = message.time_offset;
  edge.sign = message.sign;
  edge.weight = message.weight;
  edge.contrast = message.contrast;
  return edge;
}

}  // namespace

IcpModel ToMessage(const FusedModel& model, const std::string& base_frame) {
  IcpModel message;
  message.header.stamp = ToRosTime(model.stamp);
  message.header.frame_id = base_frame;
  message.laser_x = model.base_from_laser.x;
  message.laser_y = model.base_from_laser.y;
  message.laser_yaw = model.base_from_laser.theta;
  message.upside_down = model.upside_down;
  message.sweep_velocity_x = model.sweep_velocity.x;
  message.sweep_velocity_y = model.sweep_velocity.y;
  message.sweep_velocity_yaw = model.sweep_velocity.theta;
  message.has_image = model.has_image;
  const std::size_t n = model.beams.size();
  message.bearings.reserve(n);
  message.ranges.reserve(n);
  message.time_offsets.reserve(n);
  message.points_x.reserve(n);
  message.points_y.reserve(n);
  message.edge_weights.reserve(n);
  message.edge_signs.reserve(n);
  for (const ModelBeam& beam : model.beams) {
    message.bearings.push_back(static_cast<float>(beam.bearing));
    message.ranges.push_back(static_cast<float>(beam.range));
    message.time_offsets.push_back(static_cast<float>(beam.time_offset));
    message.points_x.push_back(beam.hit() ? static_cast<float>(beam.point.x()) : NAN);
    message.points_y.push_back(beam.hit() ? static_cast<float>(beam.point.y()) : NAN);
    message.edge_weights.push_back(static_cast<float>(beam.edge_weight));
    message.edge_signs.push_back(static_cast<std::int8_t>(beam.edge_sign));
  }
  for (const ModelEdge& edge : model.edges) message.edges.push_back(ToMessage(edge));
  return message;
}

FusedModel FromMessage(const IcpModel& message) {
  constexpr std::size_t kMaxEdges = 10000;
  const std::size_t n = message.ranges.size();
  if (n > kMaxBeams || message.edges.size() > kMaxEdges) {
    throw std::invalid_argument("the model has " + std::to_string(n) + " beams and " +
                                std::to_string(message.edges.size()) + " edges, at most " +
                                std::to_string(kMaxBeams) + " and " + std::to_string(kMaxEdges) +
                                " are taken");
  }
  for (const std::size_t size :
       {message.bearings.size(), message.time_offsets.size(), message.points_x.size(),
        message.points_y.size(), message.edge_weights.size(), message.edge_signs.size()}) {
    if (size != n) throw std::invalid_argument("the arrays of the model differ in length");
  }
  FusedModel model;
  if (!IsPlausiblePosition(message.laser_x, message.laser_y) || !std::isfinite(message.laser_yaw)) {
    throw std::invalid_argument("the pose of the laser is not finite, or out of this world");
  }
  model.stamp = ToStamp(message.header.stamp);
  model.base_from_laser = {message.laser_x, message.laser_y, message.laser_yaw};
  model.upside_down = message.upside_down;
  model.sweep_velocity = PlausibleVelocity(message.sweep_velocity_x, message.sweep_velocity_y,
                                           message.sweep_velocity_yaw, "the velocity");
  model.has_image = message.has_image;
  model.beams.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    ModelBeam beam;
    beam.bearing = message.bearings[i];
    beam.range = message.ranges[i];
    beam.time_offset = message.time_offsets[i];
    beam.edge_weight = message.edge_weights[i];
    beam.edge_sign = message.edge_signs[i];
    // Floats are finite together if their sum as doubles is.
    if (!std::isfinite(beam.bearing + beam.edge_weight) ||
        !(std::abs(beam.time_offset) <= kLongestSweep)) {
      throw std::invalid_argument("beam " + std::to_string(i) +
                                  " has a bearing, time or weight that can't be");
    }
    if (beam.hit()) {
      beam.point = {message.points_x[i], message.points_y[i]};
      if (!IsPlausiblePosition(beam.point.x(), beam.point.y())) {
        throw std::invalid_argument("beam " + std::to_string(i) + " has a range but no point");
      }
    }
    model.beams.push_back(beam);
  }
  for (const VerticalEdge& edge : message.edges) model.edges.push_back(FromMessage(edge));
  return model;
}

ScanMatch ToMessage(const MatchedMotion& match, const std::string& base_frame) {
  ScanMatch message;
  message.header.stamp = ToRosTime(match.stamp);
  message.header.frame_id = base_frame;
  message.start_stamp = ToRosTime(match.start_stamp);
  message.reference_stamp = ToRosTime(match.reference_stamp);
  message.reference_pose = ToPose2D(match.start_from_reference);
  message.motion = ToPose2D(match.motion);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      message.covariance[3 * row + column] = match.covariance(row, column);
    }
  }
  message.mode = static_cast<std::uint8_t>(match.mode);
  message.status = static_cast<std::uint8_t>(match.status);
  message.window_distance = match.window.half_distance;
  message.window_lateral = match.window.half_lateral;
  message.window_angle = match.window.half_angle;
  message.deviation_distance = match.deviation.distance;
  message.deviation_lateral = match.deviation.lateral;
  message.deviation_angle = match.deviation.angle;
  message.candidates = static_cast<std::uint32_t>(match.candidates);
  message.e = match.e;
  message.rms = match.rms;
  message.points = static_cast<std::uint32_t>(match.points);
  message.matched = static_cast<std::uint32_t>(match.matched);
  for (const EdgeMatch& edge : match.edges) {
    message.edge_uses.push_back(static_cast<std::uint8_t>(edge.use));
    message.edge_residuals.push_back(static_cast<float>(edge.residual));
  }
  message.degenerate_direction = match.degenerate_direction;
  message.sweep_correction_x = match.sweep_correction.x;
  message.sweep_correction_y = match.sweep_correction.y;
  message.sweep_correction_yaw = match.sweep_correction.theta;
  message.edge_correction_x = match.edge_correction.x;
  message.edge_correction_y = match.edge_correction.y;
  message.edge_correction_yaw = match.edge_correction.theta;
  message.has_odometry = match.odom_from_base.has_value();
  if (match.odom_from_base) message.odom_pose = ToPose2D(*match.odom_from_base);
  return message;
}

MatchedMotion FromMessage(const ScanMatch& message) {
  if (message.mode > ScanMatch::MODE_COASTING ||
      message.status > ScanMatch::STATUS_TOO_FEW_POINTS) {
    throw std::invalid_argument("unknown mode or status");
  }
  MatchedMotion match;
  match.stamp = ToStamp(message.header.stamp);
  match.start_stamp = ToStamp(message.start_stamp);
  match.reference_stamp = ToStamp(message.reference_stamp);
  match.start_from_reference = FromPose2D(message.reference_pose, "the reference's pose");
  match.motion = FromPose2D(message.motion, "the motion");
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      match.covariance(row, column) = message.covariance[3 * row + column];
    }
  }
  if (!match.covariance.allFinite()) {
    throw std::invalid_argument("the covariance is not finite");
  }
  match.mode = static_cast<MatchMode>(message.mode);
  match.status = static_cast<MatchStatus>(message.status);
  match.window = {message.window_distance, message.window_lateral, message.window_angle};
  match.deviation = {message.deviation_distance, message.deviation_lateral,
                     message.deviation_angle};
  match.candidates = static_cast<int>(message.candidates);
  match.e = message.e;
  match.rms = message.rms;
  match.points = static_cast<int>(message.points);
  match.matched = static_cast<int>(message.matched);
  if (message.edge_uses.size() != message.edge_residuals.size()) {
    throw std::invalid_argument("edge_uses and edge_residuals differ in length");
  }
  for (std::size_t i = 0; i < message.edge_uses.size(); ++i) {
    if (message.edge_uses[i] > ScanMatch::EDGE_REFUSED) {
      throw std::invalid_argument("unknown use of an edge");
    }
    match.edges.push_back({static_cast<EdgeUse>(message.edge_uses[i]), message.edge_residuals[i]});
  }
  match.degenerate_direction = message.degenerate_direction;
  match.sweep_correction =
      PlausibleVelocity(message.sweep_correction_x, message.sweep_correction_y,
                        message.sweep_correction_yaw, "the correction of the sweep's velocity");
  match.edge_correction =
      PlausibleVelocity(message.edge_correction_x, message.edge_correction_y,
                        message.edge_correction_yaw, "the correction of the edges' velocity");
  if (message.has_odometry) {
    match.odom_from_base = FromPose2D(message.odom_pose, "the odometry's pose");
  }
  return match;
}

geometry_msgs::Pose2D ToPose2D(const Pose2& pose) {
  geometry_msgs::Pose2D message;
  message.x = pose.x;
  message.y = pose.y;
  message.theta = pose.theta;
  return message;
}

geometry_msgs::Pose ToPoseMessage(const Pose2& pose) {
  geometry_msgs::Pose message;
  message.position.x = pose.x;
  message.position.y = pose.y;
  message.orientation.z = std::sin(pose.theta / 2.0);
  message.orientation.w = std::cos(pose.theta / 2.0);
  return message;
}

geometry_msgs::Transform ToTransformMessage(const Pose2& pose) {
  const geometry_msgs::Pose p = ToPoseMessage(pose);
  geometry_msgs::Transform message;
  message.translation.x = p.position.x;
  message.translation.y = p.position.y;
  message.rotation = p.orientation;
  return message;
}

geometry_msgs::PoseWithCovarianceStamped ToMessage(const MapPose& pose,
                                                   const std::string& map_frame) {
  geometry_msgs::PoseWithCovarianceStamped message;
  message.header.stamp = ToRosTime(pose.stamp);
  message.header.frame_id = map_frame;
  message.pose.pose = ToPoseMessage(pose.map_from_base);
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  const double c = std::cos(pose.map_from_base.theta);
  const double s = std::sin(pose.map_from_base.theta);
  rotation.topLeftCorner<2, 2>() << c, -s, s, c;
  const Eigen::Matrix3d covariance = rotation * pose.covariance * rotation.transpose();
  constexpr int kIndex[] = {0, 1, 5};  // x, y, yaw of (x, y, z, roll, pitch, yaw)
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      message.pose.covariance[6 * kIndex[row] + kIndex[column]] = covariance(row, column);
    }
  }
  return message;
}

}  // namespace scan_image_slam
