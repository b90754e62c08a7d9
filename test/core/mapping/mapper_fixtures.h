#pragma once

#include "scan_image_slam/core/mapping/mapper.h"

#include <optional>

namespace scan_image_slam {

/// A match that is told from the start of its chain.
inline MatchedMotion MatchAt(Stamp start, Stamp stamp, const Pose2& start_from_base,
                             const std::optional<Pose2>& odom_from_base = std::nullopt) {
  MatchedMotion match;
  match.start_stamp = start;
  match.reference_stamp = start;
  match.stamp = stamp;
  match.motion = start_from_base;
  match.odom_from_base = odom_from_base;
  match.status = stamp == start ? MatchStatus::kFirst : MatchStatus::kMatched;
  return match;
}

/// One beam straight ahead.
inline FusedModel WallAhead(double range) {
  FusedModel model;
  ModelBeam beam;
  beam.range = range;
  beam.point = {range, 0.0};
  model.beams.push_back(beam);
  return model;
}

/// Cells of which something is known.
inline int DrawnCells(const Mapper& mapper) {
  const CellBox& box = mapper.grid().box();
  int known = 0;
  for (int y = box.y.begin; y < box.y.end; ++y) {
    for (int x = box.x.begin; x < box.x.end; ++x) known += mapper.grid().Occupancy(x, y) >= 0;
  }
  return known;
}

}  // namespace scan_image_slam
