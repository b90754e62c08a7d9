#pragma once

#include "scan_image_slam/core/mapping/keyframe.h"
#include "scan_image_slam/core/mapping/submap.h"
#include "scan_image_slam/core/matching/refinement.h"

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace scan_image_slam {

struct LoopMatcherOptions {
  RangeNoise noise;
  RefinementOptions refinement;
  double search_spacing = 0.2;  ///< between the points that the search looks at [m]
  double min_score = 0.25;      ///< mean score of the points at the best pose of a search [-]
  double rival_score = 0.9;     ///< another place that fits so well, relatively, is a rival [-]
  double rival_distance = 0.6;  ///< poses nearer than this are the same place [m]
  double rival_angle = 0.3;     ///< [rad]
  double min_agreement = 0.8;   ///< of the points that the submap should know, on its walls [-]
  double min_overlap = 0.3;     ///< of all points, on the submap's walls [-]
  double match_distance = 0.1;  ///< from such a point to the wall [m]
  double prior_distance = 0.3;  ///< standard deviation of the start of a refinement [m]
  double prior_angle = 0.1;     ///< [rad]
};

/// What recent keyframes see, in the frame of the base at the latest one.
struct LoopQuery {
  std::vector<SurfacePoint> points;
  std::vector<ModelEdge> edges;
};

/// Where the base is in a submap.
struct LoopMatch {
  Pose2 submap_from_base;
  Eigen::Matrix3d information =
      Eigen::Matrix3d::Zero();  ///< of (forward, left, turn) [1/m^2, 1/m^2, 1/rad^2]
  double agreement = 0.0;       ///< of the points that the submap should know, on its walls [-]
  double overlap = 0.0;         ///< of all points, on the submap's walls [-]
  double contradiction = 0.0;   ///< of all points, where the submap has seen that nothing is [-]
};

/// Refines a pose that is known to about a decimetre, however well the query fits there.
LoopMatch RefineInSubmap(const LoopQuery& query, const Submap& submap,
                         const Pose2& submap_from_base, const LoopMatcherOptions& options);

/// The same, but nothing if the query does not fit there.
std::optional<LoopMatch> TrackInSubmap(const LoopQuery& query, const Submap& submap,
                                       const Pose2& submap_from_base,
                                       const LoopMatcherOptions& options);

/// Share of the points that lie behind walls of the submap, which would have hidden them [-].
double ShareBehindWalls(const LoopQuery& query, const Submap& submap,
                        const Pose2& submap_from_base);

/// Finds the pose in a window by branch and bound, and refines it. Nothing if the query fits
/// nowhere, or in more places than one.
std::optional<LoopMatch> FindInSubmap(const LoopQuery& query, Submap* submap,
                                      const PoseWindow& window, const LoopMatcherOptions& options);

}  // namespace scan_image_slam
