#pragma once

#include "scan_image_slam/core/mapping/keyframe.h"
#include "scan_image_slam/core/mapping/score_pyramid.h"
#include "scan_image_slam/core/mapping/seen_space.h"
#include "scan_image_slam/core/matching/edge_map.h"
#include "scan_image_slam/core/matching/local_map.h"

#include <memory>
#include <optional>
#include <vector>

namespace scan_image_slam {

struct SubmapOptions {
  LocalMapOptions local_map;
  EdgeMapOptions edge_map;
  RangeNoise noise;
  ScorePyramidOptions pyramid;
};

/// What some keyframes saw, put together: what later keyframes are matched with to recognise the
/// place.
class Submap {
 public:
  /// `keyframes`, not empty, where they lie in the frame of the submap.
  Submap(const std::vector<std::shared_ptr<const Keyframe>>& keyframes,
         std::vector<Pose2> submap_from_keyframes, const SubmapOptions& options);

  /// Poses of the keyframes in the frame of the submap.
  const std::vector<Pose2>& submap_from_keyframes() const { return submap_from_keyframes_; }
  const LocalMap& local_map() const { return local_map_; }
  const EdgeMap& edge_map() const { return edge_map_; }
  const SeenSpace& seen() const { return *seen_; }
  /// Made when it is first asked for: it is large, and most submaps do without.
  const ScorePyramid& pyramid();

 private:
  void FindSeenSpace(const std::vector<std::shared_ptr<const Keyframe>>& keyframes);

  std::vector<Pose2> submap_from_keyframes_;
  LocalMap local_map_;
  EdgeMap edge_map_;
  std::optional<SeenSpace> seen_;
  ScorePyramidOptions pyramid_options_;
  std::optional<ScorePyramid> pyramid_;
};

/// Poses of keyframes that follow each other without a break, in the frame of the first.
std::vector<Pose2> ChainOf(const std::vector<std::shared_ptr<const Keyframe>>& keyframes);

}  // namespace scan_image_slam
