#pragma once

#include "scan_image_slam/core/mapping/graph_ways.h"
#include "scan_image_slam/core/mapping/keyframe.h"
#include "scan_image_slam/core/mapping/map_state.h"
#include "scan_image_slam/core/mapping/pose_graph.h"

#include <optional>
#include <vector>

namespace scan_image_slam {

struct KnownPlaceOptions {
  double max_distance = 0.5;  ///< from a keyframe to the one that knows its place [m]
  double max_angle = 0.5;     ///< [rad]
  double min_overlap = 0.9;   ///< share of what it saw that was known there [-]
  int max_views = 5;          ///< kept of one place, whatever else was seen from there
  int max_visits = 3;         ///< of one place that the graph is the better for
};

/// Tells which keyframes have brought nothing new: what they saw had been seen from nearly the same
/// pose before, or as many others were kept of it as are of use. A view for the moment of what a
/// LoopCloser holds; it keeps references.
class KnownPlaces {
 public:
  KnownPlaces(const Keyframes& keyframes, const GraphPoses& poses,
              const std::vector<GraphConstraint>& constraints, const GraphLinks& links,
              const KnownPlaceOptions& options)
      : keyframes_(keyframes),
        poses_(poses),
        constraints_(constraints),
        links_(links),
        options_(options) {}

  /// The keyframe that knew what this one saw, and is kept itself; nothing if there is none.
  std::optional<int> AnchorOf(int id) const;

  /// True if as many keyframes before this one as are of use are kept with what they saw, from
  /// nearly its pose, recognised or not.
  bool HasManyViews(int id) const;

  /// True if the graph can do without a keyframe whose points were let go: its place was visited
  /// often enough, and the keyframes before and after it are known, too, so that what comes before
  /// and after such a stretch stays tied to the map.
  bool IsNeedless(int id) const;

 private:
  bool IsNear(const Pose2& from_from_to) const;
  bool IsKnown(int id) const;

  const Keyframes& keyframes_;
  const GraphPoses& poses_;
  const std::vector<GraphConstraint>& constraints_;
  const GraphLinks& links_;
  const KnownPlaceOptions& options_;
};

/// The constraints between the keyframes that are not let go: places that were recognised, and
/// the way from one such keyframe to the next. `constraints` hold the ways in the order of time.
std::vector<GraphConstraint> Without(const Anchors& let_go,
                                     const std::vector<GraphConstraint>& constraints);

}  // namespace scan_image_slam
