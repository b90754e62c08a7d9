#include "scan_image_slam/core/mapping/seen_space.h"

#include "scan_image_slam/core/mapping/grid_ray.h"

#include <cmath>

namespace scan_image_slam {
namespace {

IndexRange CellsBetween(double lower, double upper) {
  return {static_cast<int>(std::floor(lower)), static_cast<int>(std::floor(upper)) + 1};
}

}  // namespace

SeenSpace::SeenSpace(const Eigen::Vector2d& lower, const Eigen::Vector2d& upper, double cell_size)
    : cell_size_(cell_size),
      x_(CellsBetween(lower.x() / cell_size, upper.x() / cell_size)),
      y_(CellsBetween(lower.y() / cell_size, upper.y() / cell_size)),
      free_(static_cast<std::size_t>(x_.size()) * y_.size(), false) {}

void SeenSpace::AddRay(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  ForEachCellBefore(from / cell_size_, to / cell_size_, [&](int x, int y) {
    if (!x_.Contains(x) || !y_.Contains(y)) return;
    free_[static_cast<std::size_t>(y - y_.begin) * x_.size() + (x - x_.begin)] = true;
  });
}

bool SeenSpace::IsFree(const Eigen::Vector2d& place) const {
  const int x = static_cast<int>(std::floor(place.x() / cell_size_));
  const int y = static_cast<int>(std::floor(place.y() / cell_size_));
  if (x <= x_.begin || x + 1 >= x_.end || y <= y_.begin || y + 1 >= y_.end) return false;
  for (int row = y - 1; row <= y + 1; ++row) {
    const std::size_t first = static_cast<std::size_t>(row - y_.begin) * x_.size() +
                              static_cast<std::size_t>(x - x_.begin - 1);
    if (!free_[first] || !free_[first + 1] || !free_[first + 2]) return false;
  }
  return true;
}

}  // namespace scan_image_slam
