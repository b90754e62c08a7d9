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
inline Pose2 MapFromBase(const AttachedPose& pose, const std::vector<Pose2>& keyframe_poses) {
  if (pose.keyframe < 0) return pose.keyframe_from_base;
  return keyframe_poses[pose.keyframe] * pose.keyframe_from_base;
}

/// A scan in the occupancy grid.
struct DrawnScan {
  std::shared_ptr<const GridScan> scan;
  AttachedPose pose;
  Pose2 map_from_base;  ///< where it was drawn
};

/// What the back-end knows: all that it needs to go on.
struct GraphMemory {
  std::vector<std::shared_ptr<const Keyframe>> keyframes;
  std::vector<Pose2> poses;  ///< map_from_base of each keyframe
  std::vector<GraphConstraint> constraints;
  std::map<int, AttachedPose> anchors;  ///< of keyframes that the graph does without
  int closures_since_optimization = 0;  ///< of the whole graph
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
