#pragma once

#include "scan_image_slam/core/geometry/index_range.h"

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Core>

namespace scan_image_slam {

/// Which element of a set is nearest to a place, answered by one look into a sparse grid: each cell
/// within `reach` of an element stores the element nearest to the cell's centre. The answer is
/// exact at the centres and off by less than the cell's diagonal elsewhere.
class NearestField {
 public:
  /// `cell_size` and `reach` in metres, both positive.
  NearestField(double cell_size, double reach);

  /// Enters element `id` (not negative) at `position` [m].
  void Insert(int id, const Eigen::Vector2d& position);

  /// The element nearest to the cell that holds `position`, or -1 if none is within reach of it.
  int Nearest(const Eigen::Vector2d& position) const {
    const int ix = CellIndex(position.x());
    const int iy = CellIndex(position.y());
    const int tx = ix >> kTileBits;
    const int ty = iy >> kTileBits;
    if (!tiles_x_.Contains(tx) || !tiles_y_.Contains(ty)) return -1;
    const auto& tile = tiles_[TileOffset(tx, ty)];
    return tile ? (*tile)[OffsetInTile(ix, iy)].id : -1;
  }

  void Clear();

 private:
  static constexpr int kTileBits = 5;
  static constexpr int kTileSize = 1 << kTileBits;
  struct Cell {
    std::int32_t id = -1;
    float squared_distance = 0.0f;
  };
  using Tile = std::array<Cell, static_cast<std::size_t>(kTileSize) * kTileSize>;

  /// floor(value / cell size), without the call that std::floor is on a plain x86-64.
  int CellIndex(double value) const {
    const double scaled = value * inverse_cell_size_;
    const int truncated = static_cast<int>(scaled);
    return truncated - (scaled < truncated ? 1 : 0);
  }
  static std::size_t OffsetInTile(int ix, int iy) {
    constexpr int kMask = kTileSize - 1;
    return static_cast<std::size_t>(((iy & kMask) << kTileBits) | (ix & kMask));
  }
  std::size_t TileOffset(int tx, int ty) const {
    return static_cast<std::size_t>(ty - tiles_y_.begin) * tiles_x_.size() + (tx - tiles_x_.begin);
  }
  Cell& CellAt(int ix, int iy);
  void GrowTo(int tx, int ty);

  double cell_size_;
  double inverse_cell_size_;
  double reach_;
  IndexRange tiles_x_;
  IndexRange tiles_y_;
  std::vector<std::unique_ptr<Tile>> tiles_;
};

}  // namespace scan_image_slam
