#include "scan_image_slam/core/mapping/localizer.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

namespace scan_image_slam {
namespace {

/// A box around all places that the keyframes were taken at, in all directions.
PoseWindow BoxAround(const GraphPoses& poses, double margin) {
  Eigen::Vector2d lower = poses.begin()->second.translation();
  Eigen::Vector2d upper = lower;
  for (const auto& [id, pose] : poses) {
    lower = lower.cwiseMin(pose.translation());
    upper = upper.cwiseMax(pose.translation());
  }
  const Eigen::Vector2d centre = 0.5 * (lower + upper);
  PoseWindow window;
  window.centre = {centre.x(), centre.y(), 0.0};
  window.half_distance = 0.5 * (upper - lower).maxCoeff() + margin;
  window.half_angle = M_PI;
  return window;
}

/// All of a map at once.
Submap WholeMap(const GraphMemory& graph, const SubmapOptions& options) {
  std::vector<std::shared_ptr<const Keyframe>> keyframes;
  std::vector<Pose2> poses;
  for (const auto& [id, keyframe] : graph.keyframes) {
    keyframes.push_back(keyframe);
    poses.push_back(graph.poses.at(id));
  }
  return Submap(keyframes, std::move(poses), options);
}

Location At(const Sighting& sighting, const LoopMatch& match) {
  Location location;
  location.stamp = sighting.keyframe.stamp;
  location.start_stamp = sighting.start_stamp;
  location.map_from_start = match.submap_from_base * sighting.start_from_base.Inverse();
  location.agreement = match.agreement;
  return location;
}

}  // namespace

Localizer::Localizer(const GraphMemory& graph, const LocalizerOptions& options)
    : options_(options),
      map_(WholeMap(graph, options.submap)),
      anywhere_(BoxAround(graph.poses, options.margin)) {}

std::optional<Location> Localizer::Look(const Sighting& sighting) {
  Remember(sighting.keyframe);
  if (sighting.map_from_base) return Follow(sighting);
  misses_ = 0;
  return Search(sighting);
}

void Localizer::Remember(Keyframe keyframe) {
  constexpr double kDistance = 0.1;  // [m]
  constexpr double kAngle = 0.1;     // [rad]
  if (!keyframe.joined) {
    recent_.clear();
    searched_ = false;
  }
  const Pose2 moved = keyframe.previous_from_base;
  way_since_search_ += moved.translation().norm();
  angle_since_search_ += std::abs(moved.theta);
  if (!recent_.empty() && moved.translation().norm() < kDistance &&
      std::abs(moved.theta) < kAngle) {
    keyframe.previous_from_base = recent_.back().previous_from_base * moved;
    recent_.pop_back();  // a robot that stands sees the same again
  }
  recent_.push_back(std::move(keyframe));
  const auto too_old = [&](const Keyframe& k) {
    return recent_.back().way - k.way > options_.query_way;
  };
  recent_.erase(recent_.begin(), std::find_if_not(recent_.begin(), recent_.end(), too_old));
}

/// What the recent sightings have seen, from the latest one.
LoopQuery Localizer::MakeQuery() const {
  LoopQuery query;
  Pose2 base_from_keyframe;
  for (auto keyframe = recent_.rbegin(); keyframe != recent_.rend(); ++keyframe) {
    const std::vector<SurfacePoint> points = ToSurfacePoints(*keyframe, base_from_keyframe);
    query.points.insert(query.points.end(), points.begin(), points.end());
    base_from_keyframe = base_from_keyframe * keyframe->previous_from_base.Inverse();
  }
  query.edges = DistinctEdges(recent_.back().edges, options_.submap.edge_map);
  return query;
}

/// A whole map knows more than a submap: what its walls hide speaks against a place as well.
void Localizer::Judge(const LoopQuery& query, LoopMatch* match) const {
  match->contradiction += ShareBehindWalls(query, map_, match->submap_from_base);
  const double known = match->overlap + match->contradiction;
  match->agreement = known > 0.0 ? match->overlap / known : 0.0;
}

std::optional<Location> Localizer::Search(const Sighting& sighting) {
  const bool moved =
      way_since_search_ >= options_.step || angle_since_search_ >= options_.step_angle;
  if (searched_ && !moved) return std::nullopt;  // it would see the same again
  searched_ = true;
  way_since_search_ = 0.0;
  angle_since_search_ = 0.0;
  LoopMatcherOptions strict = options_.matcher;
  strict.min_score = options_.min_search_score;
  strict.rival_score = options_.max_rival_score;
  strict.min_agreement = options_.min_search_agreement;
  strict.min_overlap = options_.min_search_overlap;
  const LoopQuery query = MakeQuery();
  std::optional<LoopMatch> match = FindInSubmap(query, &map_, anywhere_, strict);
  if (!match) return std::nullopt;
  Judge(query, &*match);
  if (match->agreement < strict.min_agreement) return std::nullopt;
  return At(sighting, *match);
}

std::optional<Location> Localizer::Follow(const Sighting& sighting) {
  LoopQuery query;
  query.points = ToSurfacePoints(sighting.keyframe, Pose2());
  query.edges = DistinctEdges(sighting.keyframe.edges, options_.submap.edge_map);
  LoopMatcherOptions matcher = options_.matcher;
  matcher.min_agreement = options_.min_agreement;
  matcher.min_overlap = options_.min_overlap;
  Pose2 expected = *sighting.map_from_base;
  if (!sighting.keyframe.joined) {  // by hand, or over a motion that the matching has lost
    const PoseWindow window{expected, options_.rough_window, options_.rough_angle};
    const auto match = FindInSubmap(query, &map_, window, matcher);
    if (match) expected = match->submap_from_base;
  }
  LoopMatch match = RefineInSubmap(query, map_, expected, matcher);
  Judge(query, &match);
  if (match.agreement >= matcher.min_agreement) {
    misses_ = 0;
    if (match.overlap < matcher.min_overlap) return std::nullopt;
    return At(sighting, match);
  }
  if (match.contradiction < options_.min_contradiction) return std::nullopt;
  if (misses_++ == 0) recent_.erase(recent_.begin(), recent_.end() - 1);  // older ones lead astray
  if (misses_ < options_.max_misses) return std::nullopt;
  misses_ = 0;
  searched_ = false;
  Location lost;
  lost.stamp = sighting.keyframe.stamp;
  lost.start_stamp = sighting.start_stamp;
  lost.agreement = match.agreement;
  return lost;
}

}  // namespace scan_image_slam
