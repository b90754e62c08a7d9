#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace scan_image_slam {

/// The map of CoreSLAM: 16-bit cells that say how free a place is, with a hole around each obstacle
/// that is shaped like a V, so that a scan near its place is pulled towards it. Grows as rays need.
class HoleMap {
 public:
  static constexpr std::uint16_t kObstacle = 0;
  static constexpr std::uint16_t kFree = 65500;
  static constexpr std::uint16_t kUnknown = (kObstacle + kFree) / 2;

  /// `cell_size` [m], `hole_width` from free to free [m], `quality` is the weight of a new ray
  /// out of 256. Throws std::invalid_argument for values that are out of range.
  HoleMap(double cell_size, double hole_width, int quality);

  /// Value of the cell at a place [m]; kUnknown outside the map.
  std::uint16_t At(const Eigen::Vector2d& place) const;

  /// The same at a place in cells, counted from the map's own corner.
  std::uint16_t AtCell(int x, int y) const {
    const bool inside = static_cast<unsigned>(x) < static_cast<unsigned>(width_) &&
                        static_cast<unsigned>(y) < static_cast<unsigned>(height_);
    return inside ? cells_[static_cast<std::size_t>(y) * width_ + x] : kUnknown;
  }
  /// A place [m] in cells from the corner, not rounded.
  Eigen::Vector2d ToCells(const Eigen::Vector2d& place) const {
    return place / cell_size_ - corner_.cast<double>();
  }
  double cell_size() const { return cell_size_; }

  /// Draws the ray of a hit: free up to the hole, down to obstacle at the hit, up to free behind
  /// it.
  void DrawRay(const Eigen::Vector2d& origin, const Eigen::Vector2d& hit);

 private:
  void GrowToHold(const Eigen::Vector2d& place);
  void Blend(int x, int y, double distance_to_hit);

  double cell_size_;
  double half_hole_;
  int quality_;
  Eigen::Vector2i corner_{0, 0};  ///< cell of the map's lower left corner, in the frame of the map
  int width_ = 0;                 ///< [cells]
  int height_ = 0;
  std::vector<std::uint16_t> cells_;
};

}  // namespace scan_image_slam
