#include "scan_image_slam/core/mapping/known_places.h"

#include <cmath>

namespace scan_image_slam {
/// True if a constraint shows that the place of a keyframe was known.
bool KnownPlaces::Shows(const GraphConstraint& c, int id) const {
  return c.closes_loop() && c.to == id && c.overlap >= options_.min_overlap &&
         c.from_from_to.translation().norm() <= options_.max_distance &&
         std::abs(c.from_from_to.theta) <= options_.max_angle &&
         !keyframes_.at(c.from)->points.empty();
}

std::optional<int> KnownPlaces::AnchorOf(int id) const {
  for (const GraphLink& link : links_.at(id)) {
    if (Shows(constraints_[link.constraint], id)) return link.node;
  }
  return std::nullopt;
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
