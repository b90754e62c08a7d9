#pragma once

#include "scan_image_slam/core/matching/pose_filter.h"

#include <cmath>
#include <vector>

#include <Eigen/Core>

namespace scan_image_slam {

constexpr double kNothing = 1e-9;  // variance of a motion that is as predicted

inline PoseFilterOptions Options() {
  PoseFilterOptions options;
  options.edge_correlation = 1.0;
  options.edge_bias = 0.0;
  return options;
}

inline MotionPrediction Forward(double distance) {
  MotionPrediction prediction;
  prediction.motion = {distance, 0.0, 0.0};
  prediction.from_encoders = true;
  prediction.dt = 0.025;
  return prediction;
}

inline Eigen::Matrix3d Noise(double forward, double left, double turn) {
  return Eigen::Vector3d(forward * forward, left * left, turn * turn).asDiagonal();
}

/// What a camera on the base's centre sees of a place in the map; `yaw`: how wrong it is mounted.
inline ModelEdge EdgeTo(const Eigen::Vector2d& place, const Pose2& map_from_base, double yaw = 0.0,
                        int sign = 1) {
  const Eigen::Vector2d ray = place - map_from_base.translation();
  ModelEdge edge;
  edge.bearing = std::atan2(ray.y(), ray.x()) - map_from_base.theta - yaw;
  edge.range = ray.norm();
  edge.bearing_stddev = 0.0005;
  edge.range_stddev = 0.01;
  edge.sign = sign;
  edge.weight = 1.0;
  return edge;
}

/// The range that the laser sees at a bearing on a wall along x, as the fusion gives it.
inline void PutOnWall(double wall_y, const Pose2& map_from_base, ModelEdge* edge) {
  const double heading = edge->bearing + map_from_base.theta;
  edge->range = (wall_y - map_from_base.y) / std::sin(heading);
  edge->range_by_bearing = -edge->range / std::tan(heading);
}

/// Two images: in the second the edges that are new begin.
inline void Show(const std::vector<ModelEdge>& edges, PoseFilter* filter) {
  for (int image = 0; image < 2; ++image) filter->AddEdges(edges);
}

}  // namespace scan_image_slam
