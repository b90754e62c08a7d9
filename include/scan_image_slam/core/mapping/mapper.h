#pragma once

#include "scan_image_slam/core/fusion/fused_model.h"
#include "scan_image_slam/core/mapping/occupancy_grid.h"
#include "scan_image_slam/core/matching/matched_motion.h"

#include <optional>
#include <vector>

namespace scan_image_slam {

struct MapperOptions {
  OccupancyGridOptions grid;
  double map_update_distance_thresh = 0.1;  ///< driven since the last scan in the map [m]
  double map_update_angle_thresh = 0.1;     ///< turned since then [rad]
  double map_update_time_thresh = 1.0;      ///< passed since then [s]
  /// Throws std::invalid_argument, naming the field, if a value is out of range.
  void Validate() const;
};

/// Where the robot is, as known at one moment.
struct MapPose {
  Stamp stamp = 0;
  Pose2 map_from_base;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of (forward, left, turn) [m, m, rad]
  std::optional<Pose2> map_from_odom;                    ///< if there are encoders
};

/// The third stage of the system: chains the matches into the pose and draws the map.
class Mapper {
 public:
  explicit Mapper(const MapperOptions& options);

  /// The pose after a match. The first pose is that of the encoders, so that the map's frame begins
  /// as theirs. A chain of matches that begins anew goes on from the last known pose, carried on by
  /// the encoders; if it begins before the last match, time has gone back and the map with it.
  MapPose AddMatch(const MatchedMotion& match);
  /// Draws the scan of a match into the map, if the robot has moved or some time has passed.
  void AddModel(const FusedModel& model, const MatchedMotion& match);

  /// Sets where the robot is now in the map, e.g. because the user has said so; before the first
  /// match, where the first pose will be.
  void SetPose(const Pose2& map_from_base);

  const OccupancyGrid& grid() const { return grid_; }
  OccupancyGrid& grid() { return grid_; }

  /// Starts over with an empty map.
  void Reset() { *this = Mapper(options_); }

 private:
  bool WorthDrawing(const MatchedMotion& match, const Pose2& map_from_base) const;

  MapperOptions options_;
  OccupancyGrid grid_;
  void BeginChain(const MatchedMotion& match);

  std::optional<Stamp> start_stamp_;  ///< of the chain of matches that poses come from
  Pose2 map_from_start_;
  Eigen::Matrix3d start_covariance_ = Eigen::Matrix3d::Zero();  ///< of that start
  MapPose last_;
  bool has_pose_ = false;  ///< `last_` holds a pose that a chain can go on from
  std::optional<Stamp> drawn_stamp_;
  Pose2 map_from_drawn_;
};

}  // namespace scan_image_slam
