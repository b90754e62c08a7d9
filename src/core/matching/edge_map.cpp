#include "scan_image_slam/core/matching/edge_map.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace scan_image_slam {
namespace {

Eigen::Vector2d Direction(double angle) { return {std::cos(angle), std::sin(angle)}; }

/// What an image says of where an edge is, in the base frame: exact across the line of sight, as
/// good as the surface along it.
Eigen::Matrix2d CovarianceOf(const ModelEdge& edge, double surface_stddev) {
  const Eigen::Vector2d along = Direction(edge.bearing);
  const Eigen::Vector2d across(-along.y(), along.x());
  const double sigma_along = std::hypot(edge.range_stddev, surface_stddev);
  const double sigma_across = edge.bearing_stddev * edge.range;
  return sigma_along * sigma_along * along * along.transpose() +
         sigma_across * sigma_across * across * across.transpose();
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

EdgeMap::EdgeMap(const EdgeMapOptions& options)
    : options_(options),
      positive_(0.5 * options.gate, 2.0 * options.gate),
      negative_(0.5 * options.gate, 2.0 * options.gate) {
  options_.Validate();
}

int EdgeMap::FindId(const ModelEdge& edge, const RigidTransform2& map_from_base) const {
  const Eigen::Vector2d place = map_from_base * edge.point();
  const int id = FieldOf(edge.sign).Nearest(place);
  if (id < 0) return -1;
  const Eigen::Vector2d offset = landmarks_[id].position - place;
  return offset.norm() <= options_.gate ? id : -1;
}

const EdgeLandmark* EdgeMap::Find(const ModelEdge& edge,
                                  const RigidTransform2& map_from_base) const {
  const int id = FindId(edge, map_from_base);
  return id < 0 ? nullptr : &landmarks_[id];
}

void EdgeMap::Insert(const std::vector<ModelEdge>& edges, const Pose2& map_from_base,
                     const Eigen::Matrix3d& covariance, double way) {
  const RigidTransform2 transform(map_from_base);
  for (const ModelEdge& edge : edges) {
    const int id = FindId(edge, transform);
    const Eigen::Vector2d ray = transform.Rotate(Direction(edge.bearing));
    const Eigen::Vector2d across(-ray.y(), ray.x());
    if (id >= 0) {
      // The image measures one number: how far the landmark is off the line of sight.
      EdgeLandmark& landmark = landmarks_[id];
      const Eigen::Vector2d n(-std::sin(edge.bearing), std::cos(edge.bearing));
      const Eigen::Vector2d p = edge.point();
      const Eigen::Vector3d by_pose(n.x(), n.y(), p.x() * n.y() - p.y() * n.x());
      const double measured =
          std::pow(edge.bearing_stddev * edge.range, 2) + by_pose.dot(covariance * by_pose);
      const Eigen::Vector2d cross = landmark.covariance * across;
      const double innovation_variance = across.dot(cross) + measured;
      const double innovation = across.dot(transform * p - landmark.position);
      if (innovation * innovation > 9.0 * innovation_variance) continue;
      landmark.position += cross * (innovation / innovation_variance);
      landmark.covariance -= cross * cross.transpose() / innovation_variance;
      ++landmark.hits;
      landmark.last_seen = way;
      continue;
    }
    const Eigen::Vector2d place = transform * edge.point();
    const int neighbour = FieldOf(edge.sign).Nearest(place);
    if (neighbour >= 0 &&
        (landmarks_[neighbour].position - place).norm() < options_.min_separation) {
      continue;
    }
    EdgeLandmark landmark;
    landmark.position = place;
    const Eigen::Matrix2d in_base = CovarianceOf(edge, options_.surface_stddev);
    Eigen::Matrix2d rotation;
    rotation << std::cos(map_from_base.theta), -std::sin(map_from_base.theta),
        std::sin(map_from_base.theta), std::cos(map_from_base.theta);
    landmark.covariance = rotation * in_base * rotation.transpose();
    landmark.sign = edge.sign;
    landmark.hits = 1;
    landmark.last_seen = way;
    (edge.sign > 0 ? positive_ : negative_).Insert(static_cast<int>(landmarks_.size()), place);
    landmarks_.push_back(landmark);
  }
}

void EdgeMap::ForgetBefore(double way) {
  const auto forgotten = std::remove_if(landmarks_.begin(), landmarks_.end(),
                                        [&](const auto& e) { return e.last_seen < way; });
  if (forgotten == landmarks_.end()) return;
  landmarks_.erase(forgotten, landmarks_.end());
  positive_.Clear();
  negative_.Clear();
  for (std::size_t i = 0; i < landmarks_.size(); ++i) {
    NearestField& field = landmarks_[i].sign > 0 ? positive_ : negative_;
    field.Insert(static_cast<int>(i), landmarks_[i].position);
  }
}

}  // namespace scan_image_slam
