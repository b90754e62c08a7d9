#pragma once

#include "scan_image_slam/core/geometry/pose2.h"
#include "scan_image_slam/core/mapping/keyframe.h"
#include "scan_image_slam/core/mapping/occupancy_grid.h"
#include "scan_image_slam/core/mapping/pose_graph.h"

#include <map>
#include <memory>
#include <vector>

namespace scan_image_slam {

/// A pose that hangs on a keyframe and moves with it; those before the first hang on the map's
/// frame (-1).
struct AttachedPose {
  int keyframe = -1;
  Pose2 keyframe_from_base;
};

/// Where it is if the keyframes are at these poses, map_from_base.
inline Pose2 MapFromBase(const AttachedPose& pose, const GraphPoses& keyframe_poses) {
  if (pose.keyframe < 0) return pose.keyframe_from_base;
  return keyframe_poses.at(pose.keyframe) * pose.keyframe_from_base;
}

/// Where keyframes that were let go lie to others, by number.
using Anchors = std::map<int, AttachedPose>;

/// What hangs on a keyframe that was let go hangs on the anchor of that from now on.
inline AttachedPose Reattached(const AttachedPose& pose, const Anchors& let_go) {
  const auto anchor = let_go.find(pose.keyframe);
  if (anchor == let_go.end()) return pose;
  return {anchor->second.keyframe, anchor->second.keyframe_from_base * pose.keyframe_from_base};
}

/// The keyframes from number `begin` to `end` - 1, as far as they are kept.
struct KeyframeRange {
  int begin = 0;
  int end = 0;
  double way = 0.0;  ///< driven from the first keyframe of all to number `begin` [m]
};

/// A scan in the occupancy grid.
struct DrawnScan {
  std::shared_ptr<const GridScan> scan;
  AttachedPose pose;
  Pose2 map_from_base;  ///< where it was drawn
};

/// What the back-end knows: all that it needs to go on.
struct GraphMemory {
  Keyframes keyframes;
  GraphPoses poses;  ///< of each keyframe
  std::vector<GraphConstraint> constraints;
  Anchors let_go;  ///< keyframes that are not kept, as long as something hangs on them
  std::map<int, KeyframeRange> submaps;  ///< by number, in the order of time
  int next_to_release = 0;               ///< keyframes before it have been judged
  int closures_since_optimization = 0;   ///< of the whole graph
};

/// Where a chain of matches lay in the map when its match of `stamp` came.
struct KnownChain {
  Stamp start_stamp = 0;
  Stamp stamp = 0;
  Pose2 map_from_start;
};

/// All of a map: enough to draw it again, cell by cell, and to go on with it.
struct MapState {
  GraphMemory graph;
  std::vector<DrawnScan> drawn;
  KnownChain chain;  ///< that was followed last
};

}  // namespace scan_image_slam
