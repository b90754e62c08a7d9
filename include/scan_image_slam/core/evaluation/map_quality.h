#pragma once

#include "scan_image_slam/core/geometry/pose2.h"
#include "scan_image_slam/core/mapping/map_file.h"

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace scan_image_slam {

/// A straight surface at the height of the laser.
struct TrueWall {
  Eigen::Vector2d from{0, 0};  ///< in the world frame [m]
  Eigen::Vector2d to{0, 0};    ///< [m]
};

/// What a perfect map would show.
struct TruePlan {
  std::vector<TrueWall> walls;        ///< surfaces that the laser has met
  std::vector<Eigen::Vector2d> seen;  ///< points on them that it could measure, world frame [m]
};

struct MapQualityOptions {
  double tolerance = 0.05;       ///< a cell stands for surfaces that are so near its centre [m]
  double wall_distance = 0.25;   ///< cells so near a wall are parts of it, drawn thick [m]
  double min_wall_length = 0.5;  ///< shorter surfaces, such as legs, have no thickness [m]
  double wall_section = 1.0;     ///< of a wall; thickness is measured within one [m]
  int occupied_from = 65;        ///< as in map_saver [percent]
  /// Throws std::invalid_argument, naming the field, if a value is out of range.
  void Validate() const;
};

/// Occupied cells across the walls that they belong to.
struct WallFit {
  std::size_t cells = 0;
  double rms = 0.0;        ///< of the distances of the cells to their walls [m]
  double thickness = 0.0;  ///< standard deviation about the middle of the wall's section [m]
  double offset = 0.0;     ///< mean absolute distance of these middles to the wall, per cell [m]
};

/// How a map agrees with the plan. Shares of nothing are NaN.
struct MapQuality {
  std::vector<Eigen::Vector2i> right_cells;  ///< occupied, at a wall: column and row of the map
  std::vector<Eigen::Vector2i> false_cells;  ///< occupied where nothing is
  std::size_t seen = 0;                      ///< points of the plan
  std::vector<Eigen::Vector2d> missed;       ///< those without an occupied cell, map frame [m]
  WallFit walls;

  double Precision() const;  ///< share of the occupied cells that are right
  double Recall() const;     ///< share of the points that are in the map
};

/// Judges a map whose frame lies at `world_from_map`:
/// - precision: share of the occupied cells whose centre is within `tolerance` of a wall;
/// - recall: share of the seen points within `tolerance` of the centre of an occupied cell;
/// - walls: each occupied cell is given to the nearest wall. It counts if that is long enough, not
///   farther than `wall_distance`, and the cell lies beside the wall, not beyond an end. With the
///   signed distances d of the cells: rms of d over all cells; thickness is the second central
///   moment, the root of the mean of (d - m)^2 where m is the mean d of the cells in the same
///   section of the same wall, so that it tells how blurred or doubled walls are even where they
///   have drifted; offset is the mean of |m| over the cells. rms^2 = thickness^2 + mean of m^2.
MapQuality EvaluateMap(const MapImage& map, const TruePlan& plan, const Pose2& world_from_map,
                       const MapQualityOptions& options);

/// One line of key=value pairs; metres, percent.
std::string ToKeyValues(const MapQuality& quality);

}  // namespace scan_image_slam
