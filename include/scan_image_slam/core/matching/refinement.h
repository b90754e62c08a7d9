#pragma once

#include "scan_image_slam/core/geometry/pose2.h"
#include "scan_image_slam/core/matching/edge_map.h"
#include "scan_image_slam/core/matching/local_map.h"
#include "scan_image_slam/core/matching/surface.h"

#include <vector>

#include <Eigen/Core>

namespace scan_image_slam {

struct RefinementOptions {
  int max_iterations = 8;
  double gate = 0.1;           ///< farthest point from its element, across the wall [m]
  double along_gate = 0.07;    ///< the same along the wall: a little beyond the next element [m]
  double model_stddev = 0.02;  ///< roughness and what else the map leaves out [m]
  double kernel = 3.0;         ///< residuals of so many standard deviations count half [-]
  double correlation = 4.0;    ///< points of a scan that err together, as if one [-]
  double edge_correlation = 10.0;  ///< edges of successive images that err together, as if one [-]
  double min_normal_cosine = 0.7;  ///< between the normals of a point and its element [-]
  double degenerate_ratio = 0.03;  ///< of the eigenvalues; below, a direction is weak [-]
  /// Throws std::invalid_argument, naming the field, if a value is out of range.
  void Validate() const;
};

/// What is known of a pose before the scan is looked at. If the scan contradicts it by more than
/// `kernel` standard deviations it loses weight: wheels slip.
struct MotionPrior {
  Pose2 map_from_base;
  Eigen::Matrix3d covariance =
      Eigen::Matrix3d::Identity();  ///< of (forward, left, turn) [m, m, rad]
  double kernel = 5.0;              ///< [-]
};

struct Refinement {
  Pose2 map_from_base;
  Eigen::Matrix3d covariance =
      Eigen::Matrix3d::Zero();  ///< of (forward, left, turn) in the base frame [m, m, rad]
  Eigen::Matrix3d information =
      Eigen::Matrix3d::Zero();  ///< of scan and edges without the prior, of the same three
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();  ///< of their cost, at `linearised_at`
  Pose2 linearised_at;                ///< no more than a last small step away from the result
  double prior_weight = 1.0;          ///< what the kernel has left of the prior [-]
  int matched = 0;                    ///< points that found an element
  int matched_edges = 0;              ///< edges that found a landmark
  double rms = 0.0;                   ///< weighted residual across the walls [m]
  bool weak = false;                  ///< one direction is known much worse than the one across it
  bool degenerate = false;            ///< no wall faces it, so it was left to prior and edges
  double degenerate_direction = 0.0;  ///< in the base frame [rad]
};

/// Vertical edges that an image shows, and the map in which they are looked up.
struct EdgeEvidence {
  const std::vector<ModelEdge>& edges;
  const EdgeMap& map;
};

/// Refines a pose below the grid step: iterated least squares of the distances from the points to
/// the lines of their elements (Chen and Medioni 1992), with a robust kernel, and the prior.
/// An edge, where there are any, pulls the pose so that its line of sight meets its landmark.
Refinement Refine(const std::vector<SurfacePoint>& points, const LocalMap& map,
                  const RangeNoise& noise, const MotionPrior& prior, const Pose2& start,
                  const RefinementOptions& options, const EdgeEvidence* evidence = nullptr);

}  // namespace scan_image_slam
