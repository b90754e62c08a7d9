#include "scan_image_slam/core/baseline/hole_map.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace scan_image_slam {
namespace {

constexpr double kMargin = 10.0;  // grown at once, so that it is seldom needed [m]

int Floor(double value) { return static_cast<int>(std::floor(value)); }

}  // namespace

HoleMap::HoleMap(double cell_size, double hole_width, int quality)
    : cell_size_(cell_size), half_hole_(0.5 * hole_width), quality_(quality) {
  if (!(cell_size > 0.0)) throw std::invalid_argument("cell_size must be positive");
  if (!(hole_width > 0.0)) throw std::invalid_argument("hole_width must be positive");
  if (quality < 1 || quality > 256) throw std::invalid_argument("quality must be in [1, 256]");
}

std::uint16_t HoleMap::At(const Eigen::Vector2d& place) const {
  const Eigen::Vector2d cells = ToCells(place);
  return AtCell(Floor(cells.x()), Floor(cells.y()));
}

void HoleMap::GrowToHold(const Eigen::Vector2d& place) {
  const Eigen::Vector2d cells = ToCells(place);
  const int x = Floor(cells.x());
  const int y = Floor(cells.y());
  if (x >= 0 && x < width_ && y >= 0 && y < height_) return;
  const int margin = static_cast<int>(std::ceil(kMargin / cell_size_));
  const int left = x < 0 ? margin - x : 0;
  const int below = y < 0 ? margin - y : 0;
  const int width = left + (x >= width_ ? x + margin : width_);
  const int height = below + (y >= height_ ? y + margin : height_);
  std::vector<std::uint16_t> grown(static_cast<std::size_t>(width) * height, kUnknown);
  for (int row = 0; row < height_; ++row) {
    std::copy_n(cells_.begin() + static_cast<std::ptrdiff_t>(row) * width_, width_,
                grown.begin() + static_cast<std::ptrdiff_t>(row + below) * width + left);
  }
  cells_ = std::move(grown);
  width_ = width;
  height_ = height;
  corner_ -= Eigen::Vector2i(left, below);
}

void HoleMap::Blend(int x, int y, double distance_to_hit) {
  const double depth = std::max(0.0, 1.0 - distance_to_hit / half_hole_);
  const int value = kFree - static_cast<int>(depth * (kFree - kObstacle));
  std::uint16_t& cell = cells_[static_cast<std::size_t>(y) * width_ + x];
  cell = static_cast<std::uint16_t>(((256 - quality_) * cell + quality_ * value) / 256);
}

void HoleMap::DrawRay(const Eigen::Vector2d& origin, const Eigen::Vector2d& hit) {
  const Eigen::Vector2d ray = hit - origin;
  const double length = ray.norm();
  if (!(length > 0.0) || !std::isfinite(length)) return;
  const Eigen::Vector2d end = hit + ray * (half_hole_ / length);
  GrowToHold(origin);
  GrowToHold(end);
  // One cell for each step along the longer axis.
  const Eigen::Vector2d from = ToCells(origin);
  const Eigen::Vector2d way = ToCells(end) - from;
  const double cells = way.cwiseAbs().maxCoeff();
  const Eigen::Vector2d step = way / cells;
  const double step_length = (length + half_hole_) / cells;
  for (int i = 0; i <= cells; ++i) {
    const Eigen::Vector2d cell = from + i * step;
    Blend(Floor(cell.x()), Floor(cell.y()), std::abs(i * step_length - length));
  }
}

}  // namespace scan_image_slam
