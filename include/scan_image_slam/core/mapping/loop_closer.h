#pragma once

#include "scan_image_slam/core/mapping/graph_ways.h"
#include "scan_image_slam/core/mapping/keyframe.h"
#include "scan_image_slam/core/mapping/known_places.h"
#include "scan_image_slam/core/mapping/loop_matcher.h"
#include "scan_image_slam/core/mapping/map_state.h"
#include "scan_image_slam/core/mapping/pose_graph.h"
#include "scan_image_slam/core/mapping/submap.h"

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <vector>

namespace scan_image_slam {

struct LoopCloserOptions {
  bool enabled = true;  ///< false: keyframes stay where the matching has put them
  SubmapOptions submap;
  LoopMatcherOptions matcher;
  GraphOptions graph;
  double submap_way = 10.0;               ///< driven within one submap [m]
  double query_way = 4.0;                 ///< driven within what is compared with a submap [m]
  double min_loop_way = 25.0;             ///< driven between two visits of a place [m]
  double max_distance = 4.0;              ///< between two keyframes that see the same place [m]
  double min_window = 0.2;                ///< half of the search window [m]
  double window_per_way = 0.04;           ///< it grows with the way between two keyframes [m/m]
  double max_window = 6.0;                ///< [m]
  double min_angle = 0.05;                ///< half of the search window [rad]
  double angle_per_way = 0.006;           ///< [rad/m]
  double max_angle = 0.6;                 ///< [rad]
  double max_deviation = 5.0;             ///< of what a search finds from what the graph expects,
                                          ///< in standard deviations [-]
  double unseen_drift = 0.016;            ///< stddev of what the matching may have drifted over a
                                          ///< metre and not told, for what the graph expects [m]
  double unseen_turn = 0.005;             ///< [rad]
  double track_window = 0.5;              ///< smaller windows need no search [m]
  double closure_distance_stddev = 0.02;  ///< of a recognised place, at best [m]
  double closure_angle_stddev = 0.004;    ///< [rad]
  KnownPlaceOptions known_places;
  int max_matches = 2;  ///< submaps compared with one keyframe
  int max_cached_submaps = 12;
};

/// Recognises places seen before and keeps the poses of all keyframes consistent: the back-end of
/// the mapper. What a keyframe saw is kept to recognise its place by, unless that was known before.
class LoopCloser {
 public:
  explicit LoopCloser(const LoopCloserOptions& options);

  /// From the next keyframe on. `enabled` stays: what was not kept can't be compared later.
  void SetOptions(const LoopCloserOptions& options);

  /// Adds the next keyframe; number 0 starts a new map. Returns true if keyframes have moved.
  bool Add(std::shared_ptr<const Keyframe> keyframe);

  /// All that it knows; a closer of the same options that loads it goes on like this one.
  GraphMemory memory() const {
    return {keyframes_,
            poses_,
            constraints_,
            let_go(),
            submaps_,
            next_to_release_,
            closures_since_optimization_};
  }
  void Load(GraphMemory memory);

  /// Of the keyframes that are kept.
  const GraphPoses& poses() const { return poses_; }
  /// Keyframes that were let go, and where what hangs on them hangs from now on. They are listed
  /// until ForgetLetGo.
  Anchors let_go() const;
  /// Nothing hangs any more on keyframes that had been let go when this one came.
  void ForgetLetGo(int keyframe);
  const std::vector<GraphConstraint>& constraints() const { return constraints_; }
  /// Places that were recognised, as far as the graph holds them.
  int closures() const { return closures_; }

 private:
  void Enter(std::shared_ptr<const Keyframe> keyframe);
  void Join(const GraphConstraint& constraint);
  void JoinOnly(const std::vector<GraphConstraint>& constraints);
  void ExtendSubmaps(int id);
  Submap& GetSubmap(int id);
  std::vector<std::pair<int, int>> Candidates(int id) const;
  LoopQuery MakeQuery(int id, double way) const;
  std::optional<GraphConstraint> Close(int id, int submap_id, int near_id, const GraphWays& ways);
  void Optimize(const std::vector<GraphConstraint>& closures);
  bool Contradicted(const GraphConstraint& constraint, double deviation) const;
  bool TakeBack();
  void ReleaseKnown();
  void LetKnownGo();
  void LetGo(int id);
  double WayAt(int id) const { return keyframes_.at(id)->way; }

  LoopCloserOptions options_;
  Keyframes keyframes_;
  GraphPoses poses_;
  std::vector<GraphConstraint> constraints_;
  GraphLinks links_;
  struct LetGoKeyframe {
    int id = 0;
    int latest = 0;  ///< keyframe at that time
    AttachedPose anchor;
  };
  std::deque<LetGoKeyframe> let_go_;  ///< in the order of time
  int closures_ = 0;
  std::map<int, KeyframeRange> submaps_;  ///< by number, in the order of time
  struct CachedSubmap {
    std::unique_ptr<Submap> submap;
    int used = 0;
  };
  std::map<int, CachedSubmap> cache_;
  int use_count_ = 0;
  int closures_since_optimization_ = 0;
  int next_to_release_ = 0;  ///< keyframes before it have been judged
};

}  // namespace scan_image_slam
