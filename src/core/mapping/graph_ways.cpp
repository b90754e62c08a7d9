#include "scan_image_slam/core/mapping/graph_ways.h"

#include "scan_image_slam/core/geometry/covariance.h"

#include <queue>
#include <set>
#include <utility>

#include <Eigen/LU>

namespace scan_image_slam {
namespace {

/// Of the node `to` in the frame of the other one. Directions that a constraint tells nothing of
/// are known to a kilometre.
Eigen::Matrix3d CovarianceOf(const GraphConstraint& constraint) {
  constexpr double kNothing = 1e-6;
  return (constraint.information + kNothing * Eigen::Matrix3d::Identity()).inverse();
}

}  // namespace

GraphWays::GraphWays(const GraphLinks& links, int from, const std::vector<int>& targets) {
  std::set<int> left(targets.begin(), targets.end());
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  steps_[from].length = 0.0;
  open.push({0.0, from});
  while (!open.empty() && !left.empty()) {
    const auto [length, node] = open.top();
    open.pop();
    if (length > steps_[node].length) continue;
    left.erase(node);
    for (const GraphLink& link : links.at(node)) {
      const double longer = length + link.way;
      Step& step = steps_[link.node];
      if (longer >= step.length) continue;
      step = {longer, node, link.constraint};
      open.push({longer, link.node});
    }
  }
}

GraphWays::Step GraphWays::At(int node) const {
  const auto found = steps_.find(node);
  return found == steps_.end() ? Step() : found->second;
}

Eigen::Matrix3d GraphWays::Covariance(const std::vector<GraphConstraint>& constraints, int to,
                                      const Eigen::Matrix3d& drift) const {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (int node = to; At(node).before >= 0; node = At(node).before) {
    const GraphConstraint& constraint = constraints[At(node).constraint];
    const double way = At(node).length - At(At(node).before).length;
    const Eigen::Matrix3d step = CovarianceOf(constraint) + way * drift;
    if (constraint.from == node) {
      covariance = TransportCovariance(covariance, constraint.from_from_to) + step;
    } else {
      // Of the inverse motion: an error at its beginning.
      covariance = TransportCovariance(covariance + step, constraint.from_from_to.Inverse());
    }
  }
  return covariance;
}

}  // namespace scan_image_slam
