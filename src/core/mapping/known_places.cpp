#include "scan_image_slam/core/mapping/known_places.h"

#include <cmath>

namespace scan_image_slam {
bool KnownPlaces::IsNear(const Pose2& from_from_to) const {
  return from_from_to.translation().norm() <= options_.max_distance &&
         std::abs(NormalizeAngle(from_from_to.theta)) <= options_.max_angle;
}

bool KnownPlaces::HasManyViews(int id) const {
  const Pose2 base_from_map = poses_.at(id).Inverse();
  int views = 0;
  auto pose = poses_.begin();
  for (auto kept = keyframes_.begin(); kept->first < id; ++kept, ++pose) {
    if (!kept->second->points.empty() && IsNear(base_from_map * pose->second)) ++views;
  }
  return views >= options_.max_views;
}

std::optional<int> KnownPlaces::AnchorOf(int id) const {
  std::optional<int> beside;  // which does not know all that was seen
  for (const GraphLink& link : links_.at(id)) {
    const GraphConstraint& c = constraints_[link.constraint];
    if (!c.closes_loop() || c.to != id || keyframes_.at(c.from)->points.empty() ||
        c.from_from_to.translation().norm() > options_.max_distance) {
      continue;
    }
    if (c.overlap >= options_.min_overlap && IsNear(c.from_from_to)) return c.from;
    beside = c.from;
  }
  const bool is_judged = keyframes_.at(id)->points.empty();
  return beside && (is_judged || HasManyViews(id)) ? beside : std::nullopt;
}

/// True as well if it was let go.
bool KnownPlaces::IsKnown(int id) const { return keyframes_.count(id) == 0 || AnchorOf(id); }

bool KnownPlaces::IsNeedless(int id) const {
  if (!keyframes_.at(id)->points.empty() || !IsKnown(id - 1) || !IsKnown(id + 1)) return false;
  const std::optional<int> anchor = AnchorOf(id);
  if (!anchor) return false;
  int visits = 0;
  for (const GraphLink& link : links_.at(*anchor)) {
    if (constraints_[link.constraint].closes_loop() && link.node > *anchor && link.node < id) {
      ++visits;
    }
  }
  return visits >= options_.max_visits;
}

std::vector<GraphConstraint> Without(const Anchors& let_go,
                                     const std::vector<GraphConstraint>& constraints) {
  std::vector<GraphConstraint> kept;
  std::optional<GraphConstraint> way;  // to a keyframe that is let go
  for (const GraphConstraint& c : constraints) {
    if (c.closes_loop()) {
      if (let_go.count(c.from) == 0 && let_go.count(c.to) == 0) kept.push_back(c);
      continue;
    }
    way = way ? Chained(*way, c) : c;
    if (let_go.count(c.to) > 0) continue;
    kept.push_back(*way);
    way.reset();
  }
  return kept;
}

}  // namespace scan_image_slam
