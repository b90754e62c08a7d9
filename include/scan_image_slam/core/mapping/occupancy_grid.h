#pragma once

#include "scan_image_slam/core/geometry/index_range.h"
#include "scan_image_slam/core/geometry/pose2.h"

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace scan_image_slam {

/// What beams without a return say of the space in front of them.
enum class NoReturnPolicy {
  kIgnore,            ///< nothing: most drivers code errors like "no object"
  kClearToMax,        ///< free up to `max_range`, if the driver codes "no object" as +Inf (REP-117)
  kClearToMaxLegacy,  ///< the same for NaN, zero and ranges below the minimum
};

struct OccupancyGridOptions {
  double resolution = 0.05;              ///< side of a cell [m]
  double update_factor_occupied = 0.75;  ///< probability that a cell with one hit is occupied [-]
  double update_factor_free = 0.4;       ///< the same for a cell that one beam has crossed [-]
  double max_range = 30.0;               ///< beams are drawn up to here [m]
  int max_cells = 100000000;             ///< of the whole grid; each takes 8 bytes
  NoReturnPolicy no_return_policy = NoReturnPolicy::kIgnore;
  /// Throws std::invalid_argument, naming the field, if a value is out of range.
  void Validate() const;
};

/// One beam to be drawn into the grid.
struct GridBeam {
  Eigen::Vector2f end{0, 0};  ///< in the base frame [m]
  bool hit = true;            ///< an obstacle at the end; otherwise only free space before it
};

/// A scan to be drawn into the grid.
struct GridScan {
  Eigen::Vector2d origin{0, 0};  ///< of the beams, in the base frame [m]
  std::vector<GridBeam> beams;
};

/// Rectangle of cells: x in [x.begin, x.end), y alike.
struct CellBox {
  IndexRange x;
  IndexRange y;
  bool empty() const { return x.size() <= 0 || y.size() <= 0; }
};

/// Occupancy grid that grows in every direction. Each cell counts the scans that hit it and the
/// scans that looked through it; its log-odds follow from the two numbers (Moravec and Elfes 1985).
/// Counts do not depend on the order of the scans, and a scan can be taken out again.
class OccupancyGrid {
 public:
  explicit OccupancyGrid(const OccupancyGridOptions& options);

  /// Counts stay, and with them the size of the cells; what they mean follows the new options.
  /// Throws std::invalid_argument, and changes nothing, if a value is out of range.
  void SetOptions(const OccupancyGridOptions& options);

  /// Draws a scan taken at `map_from_base`. A cell that holds a hit of the scan is not crossed by
  /// it. Throws std::invalid_argument, and changes nothing, if the grid would become too large.
  void Add(const GridScan& scan, const Pose2& map_from_base);
  /// Undoes Add with the same arguments.
  void Remove(const GridScan& scan, const Pose2& map_from_base);

  /// Cells that the grid holds; cell (0, 0) has its lower left corner at the origin of the map.
  const CellBox& box() const { return box_; }
  double resolution() const { return options_.resolution; }

  /// -1 unknown, else probability of being occupied in percent (nav_msgs/OccupancyGrid).
  std::int8_t Occupancy(int x, int y) const;

  /// The cells that have changed since the last call.
  CellBox TakeChanges();

 private:
  struct Cell {
    std::uint16_t hits = 0;
    std::uint16_t passes = 0;
    std::uint32_t scan = 0;  ///< number of the scan that has drawn here last
  };
  void Draw(const GridScan& scan, const Pose2& map_from_base, int sign);
  void Reserve(const Eigen::Vector2d& lower, const Eigen::Vector2d& upper);
  std::size_t Offset(int x, int y) const {
    return static_cast<std::size_t>(y - box_.y.begin) * box_.x.size() + (x - box_.x.begin);
  }

  OccupancyGridOptions options_;
  CellBox box_;
  CellBox changed_;
  std::vector<Cell> cells_;
  std::uint32_t scan_number_ = 0;
};

}  // namespace scan_image_slam
