#include "scan_image_slam/core/matching/nearest_field.h"

#include <cmath>

namespace scan_image_slam {

NearestField::NearestField(double cell_size, double reach)
    : cell_size_(cell_size), inverse_cell_size_(1.0 / cell_size), reach_(reach) {}

void NearestField::Clear() {
  tiles_.clear();
  tiles_x_ = IndexRange();
  tiles_y_ = IndexRange();
}

void NearestField::Insert(int id, const Eigen::Vector2d& position) {
  const int reach_cells = static_cast<int>(std::ceil(reach_ * inverse_cell_size_));
  const int cx = CellIndex(position.x());
  const int cy = CellIndex(position.y());
  for (int iy = cy - reach_cells; iy <= cy + reach_cells; ++iy) {
    const double dy = (iy + 0.5) * cell_size_ - position.y();
    for (int ix = cx - reach_cells; ix <= cx + reach_cells; ++ix) {
      const double dx = (ix + 0.5) * cell_size_ - position.x();
      const double squared = dx * dx + dy * dy;
      if (squared > reach_ * reach_) continue;
      Cell& cell = CellAt(ix, iy);
      const float squared_distance = static_cast<float>(squared);
      if (cell.id < 0 || squared_distance < cell.squared_distance) cell = {id, squared_distance};
    }
  }
}

NearestField::Cell& NearestField::CellAt(int ix, int iy) {
  const int tx = ix >> kTileBits;
  const int ty = iy >> kTileBits;
  if (!tiles_x_.Contains(tx) || !tiles_y_.Contains(ty)) GrowTo(tx, ty);
  std::unique_ptr<Tile>& tile = tiles_[TileOffset(tx, ty)];
  if (!tile) tile = std::make_unique<Tile>();
  return (*tile)[OffsetInTile(ix, iy)];
}

void NearestField::GrowTo(int tx, int ty) {
  constexpr int kMargin = 8;  // [tiles]
  const IndexRange old_x = tiles_x_;
  const IndexRange old_y = tiles_y_;
  std::vector<std::unique_ptr<Tile>> old_tiles = std::move(tiles_);
  tiles_x_ = old_x.Including(tx, kMargin);
  tiles_y_ = old_y.Including(ty, kMargin);
  tiles_.clear();
  tiles_.resize(static_cast<std::size_t>(tiles_x_.size()) * tiles_y_.size());
  std::size_t i = 0;
  for (int y = old_y.begin; y < old_y.end; ++y) {
    for (int x = old_x.begin; x < old_x.end; ++x)
      tiles_[TileOffset(x, y)] = std::move(old_tiles[i++]);
  }
}

}  // namespace scan_image_slam
