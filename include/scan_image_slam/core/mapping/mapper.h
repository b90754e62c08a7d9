#pragma once

#include "scan_image_slam/core/fusion/fused_model.h"
#include "scan_image_slam/core/mapping/drawn_map.h"
#include "scan_image_slam/core/mapping/keyframe.h"
#include "scan_image_slam/core/mapping/localizer.h"
#include "scan_image_slam/core/mapping/map_state.h"
#include "scan_image_slam/core/matching/matched_motion.h"

#include <memory>
#include <optional>
#include <vector>

namespace scan_image_slam {

struct MapperOptions {
  OccupancyGridOptions grid;
  double map_update_distance_thresh = 0.1;  ///< driven since the last scan in the map [m]
  double map_update_angle_thresh = 0.1;     ///< turned since the last scan in the map [rad]
  double map_update_time_thresh = 1.0;      ///< passed since then [s]
  int max_scans_per_place = 5;              ///< in the map, of half a metre and 45 degrees
  KeyframeOptions keyframe;
  double keyframe_distance = 0.4;           ///< driven since the last keyframe [m]
  double keyframe_angle = 0.4;              ///< turned since then [rad]
  double keyframe_distance_stddev = 0.003;  ///< of the motion between two keyframes, at best [m]
  double keyframe_angle_stddev = 0.001;     ///< [rad]
  int max_trajectory_poses = 20000;         ///< a trajectory of more is thinned to half
  /// Throws std::invalid_argument, naming the field, if a value is out of range.
  void Validate() const;
};

/// What a map that was loaded is for.
enum class MapUse {
  kContinue,  ///< it grows once the robot has been found in it
  kLocalize,  ///< it stays as it is
};

/// Where the robot is, as known at one moment.
struct MapPose {
  Stamp stamp = 0;
  bool lost = false;  ///< not found in the loaded map yet, or not any more: the pose is none
  Pose2 map_from_base;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of (forward, left, turn) [m, m, rad]
  std::optional<Pose2> map_from_odom;                    ///< if there are encoders
};

/// The third stage of the system: chains the matches into the pose, chooses keyframes and draws the
/// map. Places that are recognised (LoopCloser) come in by Correct; where the robot is in a map
/// that was loaded (Localizer) comes in by Locate.
class Mapper {
 public:
  explicit Mapper(const MapperOptions& options);

  /// From the next match on; the map stays, with its resolution, until Reset. Throws
  /// std::invalid_argument, and changes nothing, if a value is out of range.
  void SetOptions(const MapperOptions& options);

  /// The pose after a match. The first pose is that of the encoders, so that the map's frame begins
  /// as theirs. A chain of matches that begins anew goes on from the last known pose, carried on by
  /// the encoders; if it begins before the last match, time has gone back and the map with it, but
  /// for one that was loaded: the robot is searched for in it.
  MapPose AddMatch(const MatchedMotion& match);

  /// Draws the scan of a match into the map, if the robot has moved or some time has passed.
  /// Returns the scan as a keyframe if it became one, else null.
  std::shared_ptr<const Keyframe> AddModel(const FusedModel& model, const MatchedMotion& match);

  /// The scan of a match to look for the robot by, now and then, while the map does not grow: then
  /// AddModel does nothing.
  std::optional<Sighting> Look(const FusedModel& model, const MatchedMotion& match);

  /// Moves the first keyframes to these poses, and what came later with the last. What hangs on
  /// keyframes that were let go hangs on their anchors from then on.
  void Correct(GraphPoses keyframe_poses, const Anchors& let_go);

  /// The map as it is now, but for its graph, which is the back-end's.
  MapState State() const;

  /// Takes up a map instead of the present one. The robot is lost until Locate or SetPose, unless
  /// the map is empty or the chain of matches goes on that was followed when it was saved. Throws
  /// std::invalid_argument if it is empty and to localise in.
  void Load(const MapState& state, MapUse use);

  /// The robot was found in the map, or lost. What was seen before the last SetPose is ignored.
  void Locate(const Location& location);

  /// Sets where the robot is now in the map, e.g. because the user has said so; before the first
  /// match, where the first pose will be.
  void SetPose(const Pose2& map_from_base);

  /// As if nothing had been seen yet; in a map that was loaded the robot is lost.
  void TimeWentBack();

  /// The clock was set while the robot drove on: earlier stamps than the last are no other time.
  void ClockWasSet();

  const OccupancyGrid& grid() const { return drawn_.grid(); }
  OccupancyGrid& grid() { return drawn_.grid(); }

  /// Draws scans anew where a correction has moved them, the latest first and at most so many.
  /// Returns true if none is left.
  bool Redraw(int max_scans) { return drawn_.Redraw(keyframe_poses_, max_scans); }

  /// Poses of the scans since the start or Load, as known now, but those of a lost robot: of all
  /// of them, or of some that are evenly spaced along the way if they are too many.
  std::vector<MapPose> Trajectory() const;

  /// What the map is drawn from.
  const DrawnMap& drawn() const { return drawn_; }

  bool empty() const { return keyframe_poses_.empty(); }
  bool lost() const { return lost_; }
  /// False while a loaded map stays as it is.
  bool growing() const { return !lost_ && !localize_; }

  /// Starts over with an empty map; in a map to localise in, with a lost robot.
  void Reset();

 private:
  struct TrackedPose {
    Stamp stamp = 0;
    AttachedPose pose;
  };
  void BeginChain(const MatchedMotion& match);
  void Forget();
  bool WorthDrawing(const MatchedMotion& match, const Pose2& map_from_base) const;
  bool WorthKeeping(const MatchedMotion& match) const;
  bool WorthLooking(const MatchedMotion& match) const;
  bool IsFar(const Pose2& motion) const;
  void MoveRobot(const Pose2& new_from_old);
  std::shared_ptr<const Keyframe> Keep(const FusedModel& model, const MatchedMotion& match);
  AttachedPose Attach(const Pose2& map_from_base) const;
  int NextKeyframe() const;
  void Track(const MapPose& pose);

  MapperOptions options_;
  DrawnMap drawn_;
  std::optional<Stamp> start_stamp_;  ///< of the chain of matches that poses come from
  Pose2 map_from_start_;
  Eigen::Matrix3d start_covariance_ = Eigen::Matrix3d::Zero();  ///< of that start
  MapPose last_;
  bool has_pose_ = false;  ///< `last_` holds a pose that a chain can go on from
  std::optional<Stamp> drawn_stamp_;
  Pose2 map_from_drawn_;

  GraphPoses keyframe_poses_;
  int failed_ = 0;              ///< matches in a row, up to the last one
  bool joined_ = true;          ///< the matching has followed all motion since the last keyframe
  double way_ = 0.0;            ///< driven so far [m]
  Stamp kept_start_stamp_ = 0;  ///< chain of the last keyframe
  Eigen::Matrix3d kept_covariance_ = Eigen::Matrix3d::Zero();
  std::vector<TrackedPose> tracked_;
  double tracked_spacing_ = 0.0;  ///< between them, at least [m]

  KnownChain loaded_chain_;
  bool loaded_ = false;                ///< the map was begun in an earlier run
  bool localize_ = false;              ///< the map stays as it is
  bool lost_ = false;                  ///< nobody knows where the robot is in the map
  std::optional<Stamp> told_stamp_;    ///< of the last scan before SetPose
  std::optional<Stamp> looked_stamp_;  ///< of the last sighting
  Stamp looked_start_stamp_ = 0;       ///< of its chain
  Pose2 start_from_looked_;
  double looked_way_ = 0.0;  ///< driven between sightings [m]
};

}  // namespace scan_image_slam
