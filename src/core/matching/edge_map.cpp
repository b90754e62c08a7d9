#include "scan_image_slam/core/matching/edge_map.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

namespace scan_image_slam {
namespace {

/// A landmark where an image saw an edge: exact across the line of sight, as good as the surface
/// along it.
EdgeLandmark StartLandmark(const ModelEdge& edge, const RigidTransform2& map_from_base,
                           double surface_stddev) {
  const Eigen::Vector2d along = map_from_base.Rotate(Direction(edge.bearing));
  const Eigen::Vector2d across = Across(along);
  const double sigma_along = std::hypot(edge.range_stddev, surface_stddev);
  const double sigma_across = edge.bearing_stddev * edge.range;
  EdgeLandmark landmark;
  landmark.position = map_from_base * edge.point();
  landmark.covariance = sigma_along * sigma_along * along * along.transpose() +
                        sigma_across * sigma_across * across * across.transpose();
  landmark.sign = edge.sign;
  return landmark;
}

/// The image measures one number: how far the landmark is off the line of sight. Nothing if that
/// is farther than it can be.
std::optional<EdgeLandmark> RefineLandmark(EdgeLandmark landmark, const ModelEdge& edge,
                                           const RigidTransform2& map_from_base,
                                           const Eigen::Matrix3d& pose_covariance) {
  const Eigen::Vector2d n = Across(Direction(edge.bearing));
  const Eigen::Vector2d p = edge.point();
  const Eigen::Vector3d by_pose(n.x(), n.y(), Cross(p, n));
  const double measured =
      std::pow(edge.bearing_stddev * edge.range, 2) + by_pose.dot(pose_covariance * by_pose);
  const Eigen::Vector2d across = map_from_base.Rotate(n);
  const Eigen::Vector2d cross = landmark.covariance * across;
  const double innovation_variance = across.dot(cross) + measured;
  const double innovation = across.dot(map_from_base * p - landmark.position);
  if (innovation * innovation > 9.0 * innovation_variance) return std::nullopt;
  landmark.position += cross * (innovation / innovation_variance);
  landmark.covariance -= cross * cross.transpose() / innovation_variance;
  return landmark;
}

}  // namespace

void EdgeMapOptions::Validate() const {
  const auto require = [](double value, const char* name) {
    if (!(std::isfinite(value) && value > 0.0)) {
      throw std::invalid_argument(std::string(name) + " must be positive and finite");
    }
  };
  require(gate, "gate");
  require(min_separation, "min_separation");
  require(min_weight, "min_weight");
  require(max_range, "max_range");
  require(surface_stddev, "surface_stddev");
}

std::vector<ModelEdge> DistinctEdges(const std::vector<ModelEdge>& edges,
                                     const EdgeMapOptions& options) {
  constexpr double kRival = 0.5;  // share of an edge's weight that makes another one its rival
  std::vector<ModelEdge> distinct;
  for (const ModelEdge& edge : edges) {
    if (edge.range > options.max_range || edge.weight < options.min_weight) continue;
    const bool has_rival = std::any_of(edges.begin(), edges.end(), [&](const ModelEdge& other) {
      return &other != &edge && other.sign == edge.sign && other.weight > kRival * edge.weight &&
             (other.point() - edge.point()).norm() < options.min_separation;
    });
    if (!has_rival) distinct.push_back(edge);
  }
  return distinct;
}

EdgeMap::EdgeMap(const EdgeMapOptions& options) : options_(options) { options_.Validate(); }

int EdgeMap::NearestId(const Eigen::Vector2d& place, int sign, double reach) const {
  int nearest = -1;
  double least = reach * reach;
  for (std::size_t i = 0; i < landmarks_.size(); ++i) {
    const double squared = (landmarks_[i].position - place).squaredNorm();
    if (squared > least || landmarks_[i].sign != sign) continue;
    least = squared;
    nearest = static_cast<int>(i);
  }
  return nearest;
}

const EdgeLandmark* EdgeMap::Find(const ModelEdge& edge,
                                  const RigidTransform2& map_from_base) const {
  const int id = NearestId(map_from_base * edge.point(), edge.sign, options_.gate);
  return id < 0 ? nullptr : &landmarks_[id];
}

void EdgeMap::Insert(const std::vector<ModelEdge>& edges, const Pose2& map_from_base,
                     const Eigen::Matrix3d& covariance) {
  const RigidTransform2 transform(map_from_base);
  for (const ModelEdge& edge : edges) {
    const Eigen::Vector2d place = transform * edge.point();
    int id = NearestId(place, edge.sign, options_.gate);
    if (id >= 0) {
      const auto refined = RefineLandmark(landmarks_[id], edge, transform, covariance);
      if (!refined) continue;
      landmarks_[id] = *refined;
    } else {
      if (NearestId(place, edge.sign, options_.min_separation) >= 0) continue;
      id = static_cast<int>(landmarks_.size());
      landmarks_.push_back(StartLandmark(edge, transform, options_.surface_stddev));
    }
    ++landmarks_[id].hits;
  }
}

}  // namespace scan_image_slam
