#pragma once

#include "scan_image_slam/core/mapping/map_state.h"
#include "scan_image_slam/core/mapping/occupancy_grid.h"

#include <array>
#include <cstddef>
#include <map>
#include <set>
#include <vector>

namespace scan_image_slam {

/// The occupancy grid and the scans that it is drawn from, which can be drawn anew where the graph
/// has moved them. Of scans taken at the same place and in the same direction only the latest are
/// kept: a known building needs no more memory however long the robot drives in it, and what has
/// been moved away leaves the map.
class DrawnMap {
 public:
  DrawnMap(const OccupancyGridOptions& options, int max_scans_per_place);

  /// As OccupancyGrid::SetOptions.
  void SetOptions(const OccupancyGridOptions& options, int max_scans_per_place);

  /// Draws a scan and takes out the oldest of its place if those are too many. Throws
  /// std::invalid_argument, and changes nothing, if the grid would become too large.
  void Add(DrawnScan scan);

  /// Draws all scans of a saved map.
  void Load(const std::vector<DrawnScan>& scans);

  /// Keyframes were let go: their scans hang on the anchors of those.
  void Reattach(const Anchors& let_go);

  /// Makes Redraw look at all scans once more: keyframes have moved.
  void BeginRedraw() { to_redraw_ = next_; }

  /// Draws scans anew whose keyframes have moved to these poses, map_from_base, the latest first
  /// and at most so many. Returns true if none is left.
  bool Redraw(const GraphPoses& keyframe_poses, int max_scans);

  /// In the order of time.
  std::vector<DrawnScan> scans() const;
  std::size_t size() const { return scans_.size(); }

  const OccupancyGrid& grid() const { return grid_; }
  OccupancyGrid& grid() { return grid_; }

 private:
  using Place = std::array<int, 3>;  ///< column, row and sector of the heading
  static Place PlaceOf(const Pose2& map_from_base);
  void Keep(DrawnScan scan);

  OccupancyGrid grid_;
  int max_scans_per_place_;
  std::map<int, DrawnScan> scans_;         ///< by number, in the order of time
  std::map<Place, std::set<int>> places_;  ///< numbers of the scans drawn there
  int next_ = 0;                           ///< number of the next scan
  int to_redraw_ = 0;                      ///< scans before this one may lie where they were
};

}  // namespace scan_image_slam
