#pragma once

#include "scan_image_slam/core/geometry/pose2.h"

#include <vector>

#include <Eigen/Core>
#include <boost/container/flat_map.hpp>

namespace scan_image_slam {

/// map_from_base of each node, by number; numbers of nodes that were let go are missing.
using GraphPoses = boost::container::flat_map<int, Pose2>;

/// A measured pose of one node in the frame of another.
struct GraphConstraint {
  int from = 0;
  int to = 0;
  Pose2 from_from_to;
  Eigen::Matrix3d information =
      Eigen::Matrix3d::Identity();  ///< of (forward, left, turn) of `to` [1/m^2, 1/m^2, 1/rad^2]
  bool robust = false;              ///< it may be wrong: Cauchy's loss
  double overlap = 0.0;  ///< share of what `to` saw that was known there; a motion: 0 [-]

  /// True if it tells of a place seen before, not of the way from one keyframe to the next.
  bool closes_loop() const { return overlap > 0.0; }
};

/// What two motions in a row tell of the pose of the last node in the frame of the first.
GraphConstraint Chained(const GraphConstraint& first, const GraphConstraint& second);

/// Squared residual of a constraint, in standard deviations.
double SquaredResidual(const GraphConstraint& constraint, const GraphPoses& nodes);

struct GraphOptions {
  int max_iterations = 20;
  double kernel = 3.0;  ///< a robust residual of so many standard deviations counts half [-]
};

/// Moves nodes to the poses that fit the constraints best (least squares, by Ceres). Nodes before
/// `first_free` stay where they are; at least the first one does, and those without a constraint.
void OptimizeGraph(const std::vector<GraphConstraint>& constraints, int first_free,
                   const GraphOptions& options, GraphPoses* nodes);

}  // namespace scan_image_slam
