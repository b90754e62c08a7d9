#pragma once

#include "scan_image_slam/core/fusion/fused_model.h"
#include "scan_image_slam/core/geometry/pose2.h"
#include "scan_image_slam/core/matching/matched_motion.h"
#include "scan_image_slam/core/matching/surface.h"

#include <memory>
#include <vector>

#include <Eigen/Core>
#include <boost/container/flat_map.hpp>

namespace scan_image_slam {

/// A surface point as it is kept, in the base frame.
struct KeptPoint {
  Eigen::Vector2f point{0, 0};   ///< [m]
  Eigen::Vector2f normal{0, 0};  ///< unit vector towards the laser; zero where no line fits
  float angle_variance = 0.0f;   ///< of the direction of the normal [rad^2]
};

/// A scan that is kept: a node of the pose graph.
struct Keyframe {
  int id = 0;  ///< number in the order of time, from 0
  Stamp stamp = 0;
  double way = 0.0;          ///< driven from the first keyframe to here [m]
  bool joined = true;        ///< false: the matching has begun anew since the keyframe before
  Pose2 previous_from_base;  ///< motion since the keyframe before; of the first: map_from_base
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of that motion: (forward, left, turn)
                                                         ///< in the base frame [m, m, rad]
  Eigen::Vector2d laser{0, 0};    ///< where the rays start, in the base frame [m]
  std::vector<KeptPoint> points;  ///< none if the place was known well enough before
  std::vector<ModelEdge> edges;
};

/// By number; those that were let go are missing.
using Keyframes = boost::container::flat_map<int, std::shared_ptr<const Keyframe>>;

struct KeyframeOptions {
  double point_spacing = 0.04;  ///< along a wall [m]
  RangeNoise noise;
  SurfaceOptions surface;
};

/// The points and edges of a matched scan; how it lies to the keyframe before is left to the
/// caller.
Keyframe MakeKeyframe(const FusedModel& model, const MatchedMotion& match,
                      const KeyframeOptions& options);

/// Points as the matching wants them, moved by `target_from_base`.
std::vector<SurfacePoint> ToSurfacePoints(const Keyframe& keyframe, const Pose2& target_from_base);

}  // namespace scan_image_slam
