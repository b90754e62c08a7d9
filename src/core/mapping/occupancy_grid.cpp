#include "scan_image_slam/core/mapping/occupancy_grid.h"

#include "scan_image_slam/core/mapping/grid_ray.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace scan_image_slam {
namespace {

/// Margin that a grid grows by beyond what is needed [cells].
constexpr int kGrowth = 64;

double LogOdds(double probability) { return std::log(probability / (1.0 - probability)); }

void Count(std::uint16_t* counter, int sign) {
  if (sign > 0 && *counter == std::numeric_limits<std::uint16_t>::max()) return;
  *counter = static_cast<std::uint16_t>(*counter + sign);
}

}  // namespace

void OccupancyGridOptions::Validate() const {
  const auto require = [](bool ok, const char* what) {
    if (!ok) throw std::invalid_argument(what);
  };
  require(std::isfinite(resolution) && resolution > 0.0, "resolution must be positive");
  require(update_factor_occupied > 0.5 && update_factor_occupied < 1.0,
          "update_factor_occupied must lie between 0.5 and 1");
  require(update_factor_free > 0.0 && update_factor_free < 0.5,
          "update_factor_free must lie between 0 and 0.5");
  require(std::isfinite(max_range) && max_range > 0.0, "max_range must be positive");
  require(max_cells > 0, "max_map_cells must be positive");
}

OccupancyGrid::OccupancyGrid(const OccupancyGridOptions& options) : options_(options) {
  options_.Validate();
}

void OccupancyGrid::SetOptions(const OccupancyGridOptions& options) {
  options.Validate();
  const double resolution = options_.resolution;
  options_ = options;
  options_.resolution = resolution;
  changed_ = box_;
}

void OccupancyGrid::Add(const GridScan& scan, const Pose2& map_from_base) {
  Draw(scan, map_from_base, 1);
}

void OccupancyGrid::Remove(const GridScan& scan, const Pose2& map_from_base) {
  Draw(scan, map_from_base, -1);
}

void OccupancyGrid::Draw(const GridScan& scan, const Pose2& map_from_base, int sign) {
  const RigidTransform2 transform(map_from_base);
  const double cells_per_metre = 1.0 / options_.resolution;
  const Eigen::Vector2d origin = (transform * scan.origin) * cells_per_metre;
  std::vector<Eigen::Vector2d> ends;
  ends.reserve(scan.beams.size());
  Eigen::Vector2d lower = origin;
  Eigen::Vector2d upper = origin;
  for (const GridBeam& beam : scan.beams) {
    ends.push_back((transform * beam.end.cast<double>()) * cells_per_metre);
    lower = lower.cwiseMin(ends.back());
    upper = upper.cwiseMax(ends.back());
  }
  Reserve(lower, upper);

  // Hits first: a cell counts once per scan, and an obstacle weighs more than a beam that grazes
  // it.
  ++scan_number_;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    if (!scan.beams[i].hit) continue;
    Cell& cell = cells_[Offset(static_cast<int>(std::floor(ends[i].x())),
                               static_cast<int>(std::floor(ends[i].y())))];
    if (cell.scan == scan_number_) continue;
    cell.scan = scan_number_;
    Count(&cell.hits, sign);
  }
  for (const Eigen::Vector2d& end : ends) {
    ForEachCellBefore(origin, end, [&](int x, int y) {
      Cell& cell = cells_[Offset(x, y)];
      if (cell.scan == scan_number_) return;
      cell.scan = scan_number_;
      Count(&cell.passes, sign);
    });
  }
}

/// Makes room for what lies between two corners, given in cells, and marks it as changed.
void OccupancyGrid::Reserve(const Eigen::Vector2d& lower, const Eigen::Vector2d& upper) {
  constexpr double kFarthest = 1e9;  // number of a cell; more would not be counted by int
  if (!(lower.minCoeff() > -kFarthest && upper.maxCoeff() < kFarthest)) {
    throw std::invalid_argument("the scan lies too far away to be drawn into the map");
  }
  const IndexRange needed_x{static_cast<int>(std::floor(lower.x())) - 1,
                            static_cast<int>(std::floor(upper.x())) + 2};
  const IndexRange needed_y{static_cast<int>(std::floor(lower.y())) - 1,
                            static_cast<int>(std::floor(upper.y())) + 2};
  const auto include = [](const IndexRange& range, const IndexRange& needed) {
    return range.Including(needed.begin, kGrowth).Including(needed.end - 1, kGrowth);
  };
  const CellBox old = box_;
  const CellBox grown = {include(old.x, needed_x), include(old.y, needed_y)};
  const double size = static_cast<double>(grown.x.size()) * grown.y.size();
  if (size > options_.max_cells) {
    throw std::invalid_argument("the map would have to grow to " + std::to_string(grown.x.size()) +
                                " x " + std::to_string(grown.y.size()) +
                                " cells, more than max_map_cells");
  }
  const auto unite = [](const IndexRange& a, const IndexRange& b) {
    if (a.size() == 0) return b;
    return IndexRange{std::min(a.begin, b.begin), std::max(a.end, b.end)};
  };
  changed_ = {unite(changed_.x, needed_x), unite(changed_.y, needed_y)};
  box_ = grown;
  if (box_.x.size() == old.x.size() && box_.y.size() == old.y.size()) return;
  std::vector<Cell> cells(static_cast<std::size_t>(box_.x.size()) * box_.y.size());
  for (int y = old.y.begin; y < old.y.end; ++y) {
    const auto row = cells_.begin() + static_cast<std::ptrdiff_t>(y - old.y.begin) * old.x.size();
    std::copy(row, row + old.x.size(), cells.begin() + Offset(old.x.begin, y));
  }
  cells_ = std::move(cells);
}

std::int8_t OccupancyGrid::Occupancy(int x, int y) const {
  if (!box_.x.Contains(x) || !box_.y.Contains(y)) return -1;
  const Cell& cell = cells_[Offset(x, y)];
  if (cell.hits == 0 && cell.passes == 0) return -1;
  const double log_odds = cell.hits * LogOdds(options_.update_factor_occupied) +
                          cell.passes * LogOdds(options_.update_factor_free);
  return static_cast<std::int8_t>(std::lround(100.0 / (1.0 + std::exp(-log_odds))));
}

CellBox OccupancyGrid::TakeChanges() {
  const CellBox changed = changed_;
  changed_ = CellBox();
  return changed;
}

}  // namespace scan_image_slam
