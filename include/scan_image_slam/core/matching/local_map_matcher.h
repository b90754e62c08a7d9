#pragma once

#include "scan_image_slam/core/matching/bounded_search.h"
#include "scan_image_slam/core/matching/local_map.h"
#include "scan_image_slam/core/matching/match_outcome.h"
#include "scan_image_slam/core/matching/motion_predictor.h"
#include "scan_image_slam/core/matching/pose_filter.h"
#include "scan_image_slam/core/matching/refinement.h"
#include "scan_image_slam/core/matching/surface.h"

#include <optional>
#include <vector>

namespace scan_image_slam {

struct LocalMapMatcherOptions {
  SearchGrid grid;
  double point_spacing = 0.2;  ///< between the points that the search looks at [m]
  double max_distance = 0.2;   ///< most that one point adds to e [m]
  RangeNoise noise;
  SurfaceOptions surface;
  LocalMapOptions local_map;
  PoseFilterOptions filter;
  RefinementOptions refinement;
  double prior_kernel = 5.0;      ///< see MotionPrior [-]
  double insert_distance = 0.05;  ///< from the last scan that entered the map [m]
  double insert_angle = 0.05;     ///< [rad]
  int insert_first = 20;          ///< scans at the start that enter the map in any case
  double forget_distance =
      20.0;  ///< what was not seen on the last stretch of this length drops [m]
  double min_matched_fraction = 0.2;  ///< of the points of a scan, to enter it into the map [-]
  /// Throws std::invalid_argument, naming the field, if a value is out of range.
  void Validate() const;
};

/// Matches scans with everything seen so far: exhaustive search in the window, then refinement, and
/// a filter that adds what encoders and images tell.
class LocalMapMatcher {
 public:
  explicit LocalMapMatcher(const LocalMapMatcherOptions& options);

  /// From the next scan on; what is in the map stays, and `local_map` and `noise` with it.
  void SetOptions(const LocalMapMatcherOptions& options);

  /// The first scan, which starts the map.
  void Start(const FusedModel& model, const Pose2& map_from_base);

  /// Finds the motion since `map_from_last`, and adds the scan to the map if the base has moved.
  MatchOutcome Match(const FusedModel& model, const Pose2& map_from_last,
                     const MotionPrediction& prediction);

  const LocalMap& local_map() const { return local_map_; }
  const PoseFilter& filter() const { return filter_; }

 private:
  /// A scan laid on the map.
  struct Alignment {
    std::vector<SurfacePoint> points;  ///< of the scan, corrected for its sweep
    int standing = 0;                  ///< of them, those on nothing that may walk
    Velocity2 sweep_correction;
    /// Of the edges: over the time from the image to the scan the encoders' steps matter more.
    Velocity2 edge_correction;
    SearchResult found;
    Refinement refined;
    bool ShowsAtLeast(double fraction) const {
      return refined.matched > 0 && refined.matched >= fraction * standing;
    }
  };
  Alignment Align(const FusedModel& model, const Pose2& map_from_last,
                  const MotionPrediction& prediction) const;
  SearchResult Search(const std::vector<SurfacePoint>& points, const Pose2& map_from_predicted,
                      const MotionPrediction& prediction) const;
  bool MayWalk(const SurfacePoint& point, const RigidTransform2& map_from_base) const;
  std::vector<SurfacePoint> Standing(std::vector<SurfacePoint> points,
                                     const Pose2& map_from_base) const;
  std::vector<ModelEdge> WithoutWalkers(std::vector<ModelEdge> edges,
                                        const std::vector<SurfacePoint>& points,
                                        const Pose2& map_from_base) const;
  std::vector<EdgeMatch> Filter(const Alignment& alignment, std::vector<ModelEdge> edges,
                                const Pose2& map_from_last, const MotionPrediction& prediction);
  bool EdgesHold() const;
  void ForgetOldSurroundings();
  void InsertIfMoved(const std::vector<SurfacePoint>& points, const Pose2& map_from_base);

  LocalMapMatcherOptions options_;
  LocalMap local_map_;
  PoseFilter filter_;
  Pose2 map_from_inserted_;
  int inserted_ = 0;
  bool was_degenerate_ = false;         ///< the last scan left a direction to others
  int unmatched_ = 0;                   ///< scans since the last that showed something known
  int blind_ = 0;                       ///< scans in a row that were left undecided
  double way_ = 0.0;                    ///< driven so far [m]
  double time_ = 0.0;                   ///< since the start [s]
  std::optional<double> way_at_edges_;  ///< when an image told something the last time
  double way_at_forgetting_ = 0.0;
};

}  // namespace scan_image_slam
