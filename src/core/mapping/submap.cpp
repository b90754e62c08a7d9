#include "scan_image_slam/core/mapping/submap.h"

#include <utility>

namespace scan_image_slam {

Submap::Submap(const std::vector<std::shared_ptr<const Keyframe>>& keyframes,
               std::vector<Pose2> submap_from_keyframes, const SubmapOptions& options)
    : submap_from_keyframes_(std::move(submap_from_keyframes)),
      local_map_(options.local_map, options.noise),
      edge_map_(options.edge_map),
      pyramid_options_(options.pyramid) {
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    local_map_.Insert(ToSurfacePoints(*keyframes[i], Pose2()), submap_from_keyframes_[i]);
    edge_map_.Insert(DistinctEdges(keyframes[i]->edges, options.edge_map),
                     submap_from_keyframes_[i], keyframes[i]->covariance);
  }
  FindSeenSpace(keyframes);
}

void Submap::FindSeenSpace(const std::vector<std::shared_ptr<const Keyframe>>& keyframes) {
  constexpr double kCell = 0.1;  // [m]
  Eigen::Vector2d lower(0, 0);
  Eigen::Vector2d upper(0, 0);
  for (const SurfaceElement& element : local_map_.elements()) {
    lower = lower.cwiseMin(element.position.cast<double>());
    upper = upper.cwiseMax(element.position.cast<double>());
  }
  seen_.emplace(lower, upper, kCell);
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    const RigidTransform2 submap_from_base(submap_from_keyframes_[i]);
    const Eigen::Vector2d laser = submap_from_base * keyframes[i]->laser;
    for (const KeptPoint& point : keyframes[i]->points) {
      seen_->AddRay(laser, submap_from_base * point.point.cast<double>());
    }
  }
}

const ScorePyramid& Submap::pyramid() {
  if (!pyramid_) {
    std::vector<Eigen::Vector2d> places;
    for (const SurfaceElement& element : local_map_.elements()) {
      places.push_back(element.position.cast<double>());
    }
    pyramid_.emplace(places, pyramid_options_);
  }
  return *pyramid_;
}

std::vector<Pose2> ChainOf(const std::vector<std::shared_ptr<const Keyframe>>& keyframes) {
  std::vector<Pose2> poses;
  poses.reserve(keyframes.size());
  for (const auto& keyframe : keyframes) {
    poses.push_back(poses.empty() ? Pose2() : poses.back() * keyframe->previous_from_base);
  }
  return poses;
}

}  // namespace scan_image_slam
