#pragma once

#include "scan_image_slam/core/mapping/keyframe.h"
#include "scan_image_slam/core/mapping/loop_matcher.h"
#include "scan_image_slam/core/mapping/map_state.h"
#include "scan_image_slam/core/mapping/submap.h"

#include <optional>
#include <vector>

namespace scan_image_slam {

/// A scan that is to be found in a finished map.
struct Sighting {
  Keyframe keyframe;  ///< told from the sighting before as keyframes are from one another
  std::optional<Pose2> map_from_base;  ///< where the robot is thought to be; nothing: it is lost
  Stamp start_stamp = 0;               ///< chain of matches that the sighting belongs to
  Pose2 start_from_base;               ///< where it lies in that chain
};

/// Where a chain of matches lies in the map.
struct Location {
  Stamp stamp = 0;                      ///< of the sighting that has told it
  Stamp start_stamp = 0;                ///< of the chain
  std::optional<Pose2> map_from_start;  ///< nothing: the robot is not where it was thought to be
  double agreement = 0.0;               ///< of the sighting with the map [-]
};

struct LocalizerOptions {
  SubmapOptions submap;
  LoopMatcherOptions matcher;
  double query_way = 6.0;              ///< driven within what is searched for at once [m]
  double step = 0.3;                   ///< driven between two searches [m]
  double step_angle = 0.3;             ///< or turned [rad]
  double margin = 3.0;                 ///< so far outside the places visited it is searched [m]
  double max_rival_score = 0.8;        ///< another place that fits so well makes it ambiguous [-]
  double min_search_score = 0.5;       ///< mean score of the points at the best place [-]
  double min_search_agreement = 0.85;  ///< of the points that the map should know [-]
  double min_search_overlap = 0.6;     ///< of all points, on walls of the map [-]
  double rough_window = 1.5;           ///< half of the search around a pose said by a person [m]
  double rough_angle = 0.5;            ///< [rad]
  double min_agreement = 0.7;          ///< below it a sighting speaks against where it should be,
  double min_contradiction = 0.2;      ///< if so much of it should not be there or not be seen
  double min_overlap = 0.3;            ///< below it the surroundings are not in the map
  int max_misses = 4;                  ///< so many of them in a row: the robot is elsewhere
};

/// Finds and follows the robot in a map that stays as it is.
class Localizer {
 public:
  /// `graph` holds at least one keyframe.
  Localizer(const GraphMemory& graph, const LocalizerOptions& options);

  /// Where the next sighting shows the robot to be. Nothing if it leaves things as they were: a
  /// lost robot may be in more places than one, or surroundings are not in the map.
  std::optional<Location> Look(const Sighting& sighting);

 private:
  void Remember(Keyframe keyframe);
  LoopQuery MakeQuery() const;
  void Judge(const LoopQuery& query, LoopMatch* match) const;
  std::optional<Location> Search(const Sighting& sighting);
  std::optional<Location> Follow(const Sighting& sighting);

  LocalizerOptions options_;
  Submap map_;  ///< all keyframes at once
  PoseWindow anywhere_;
  std::vector<Keyframe> recent_;     ///< sightings without a break, the latest last
  double way_since_search_ = 0.0;    ///< [m]
  double angle_since_search_ = 0.0;  ///< [rad]
  bool searched_ = false;            ///< in vain, since the last break
  int misses_ = 0;
};

}  // namespace scan_image_slam
