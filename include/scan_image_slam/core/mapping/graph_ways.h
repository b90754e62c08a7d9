#pragma once

#include "scan_image_slam/core/mapping/pose_graph.h"

#include <limits>
#include <unordered_map>
#include <vector>

#include <Eigen/Core>

namespace scan_image_slam {

/// A constraint as one of its two nodes sees it.
struct GraphLink {
  int node = 0;        ///< at the other end
  int constraint = 0;  ///< index
  double way = 0.0;    ///< length, as a measure of how far both may have drifted apart [m]
};

/// Constraints by node: the links of each.
using GraphLinks = boost::container::flat_map<int, std::vector<GraphLink>>;

/// The shortest ways through a graph from one node to some others (Dijkstra).
class GraphWays {
 public:
  /// Looks no farther than the farthest of `targets`.
  GraphWays(const GraphLinks& links, int from, const std::vector<int>& targets);

  /// Length of the way to a target [m]; infinite if there is none.
  double Length(int to) const { return At(to).length; }

  /// Covariance of the pose of `from` in the frame of the target `to` that the constraints along
  /// the way add up to, and `drift` for each metre of it: (forward, left, turn) of `from`
  /// [m, m, rad].
  Eigen::Matrix3d Covariance(const std::vector<GraphConstraint>& constraints, int to,
                             const Eigen::Matrix3d& drift = Eigen::Matrix3d::Zero()) const;

 private:
  /// The last step of the way to a node.
  struct Step {
    double length = std::numeric_limits<double>::infinity();
    int before = -1;
    int constraint = -1;
  };
  Step At(int node) const;

  std::unordered_map<int, Step> steps_;  ///< to the nodes that were reached
};

}  // namespace scan_image_slam
