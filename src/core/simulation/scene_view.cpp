#include "scan_image_slam/core/simulation/scene_view.h"

#include "spots.h"

#include <algorithm>
#include <cmath>

namespace scan_image_slam {
namespace {

constexpr double kNearest = 0.005;       // nothing is seen nearer than this [m]
constexpr float kThinnest = 1.0F / 512;  // fraction of a column that is left out

/// Directions of the plan from which something is seen, as an interval that may exceed +-pi.
struct BearingRange {
  double low;
  double high;
};

BearingRange RangeOf(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const double bearing = std::atan2(a.y(), a.x());
  const double turn = std::atan2(Cross(a, b), a.dot(b));
  return {bearing + std::min(turn, 0.0), bearing + std::max(turn, 0.0)};
}

/// Of a convex outline that is seen from outside.
BearingRange RangeOf(const std::vector<Eigen::Vector2d>& corners) {
  BearingRange range{0.0, 0.0};
  const Eigen::Vector2d& first = corners.front();
  for (const Eigen::Vector2d& corner : corners) {
    const double turn = std::atan2(Cross(first, corner), first.dot(corner));
    range = {std::min(range.low, turn), std::max(range.high, turn)};
  }
  const double bearing = std::atan2(first.y(), first.x());
  return {bearing + range.low, bearing + range.high};
}

bool IsInside(const std::vector<Eigen::Vector2d>& corners) {
  int left = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    left += Cross(corners[i], corners[(i + 1) % corners.size()]) > 0.0 ? 1 : 0;
  }
  return left == 0 || left == static_cast<int>(corners.size());
}

void AddFragments(const BearingGrid& grid, const BearingRange& range, Fragment fragment,
                  std::vector<std::vector<Fragment>>& columns) {
  constexpr double kAhead = M_PI_2 - 1e-6;
  for (const double turn : {-2.0 * M_PI, 0.0, 2.0 * M_PI}) {
    if (range.low + turn >= kAhead || range.high + turn <= -kAhead) continue;
    const double low = grid.Column(std::max(range.low + turn, -kAhead));
    const double high = grid.Column(std::min(range.high + turn, kAhead));
    const int first = static_cast<int>(std::clamp<double>(std::floor(low), 0, grid.columns));
    const int last = static_cast<int>(std::clamp<double>(std::ceil(high), 0, grid.columns));
    for (int j = first; j < last; ++j) {
      fragment.begin = static_cast<float>(std::max(low - j, 0.0));
      fragment.end = static_cast<float>(std::min(high - j, 1.0));
      if (fragment.end - fragment.begin > kThinnest) columns[j].push_back(fragment);
    }
  }
}

class SceneBuilder {
 public:
  SceneBuilder(const World& world, const SceneView& view, const BearingGrid& grid)
      : world_(world), view_(view), grid_(grid), view_from_world_(-view.heading) {
    scene_.columns.resize(grid.columns);
    for (std::vector<Fragment>& column : scene_.columns) column.reserve(16);
  }

  ViewedScene Build() {
    for (const Wall& wall : world_.walls) Add(wall);
    for (const Person& person : world_.people) {
      for (const Wall& wall : BodyWalls(person, view_.time)) Add(wall);
    }
    for (const Slab& slab : world_.slabs) Add(slab);
    return std::move(scene_);
  }

 private:
  Eigen::Vector2d ToView(const Eigen::Vector2d& point) const {
    return view_from_world_ * (point - view_.position);
  }

  void Add(const Wall& wall) {
    const Eigen::Vector2d from = ToView(wall.from);
    const Eigen::Vector2d to = ToView(wall.to);
    const double length = (to - from).norm();
    if (length <= 0.0) return;
    ViewedWall viewed;
    viewed.edge = (to - from) / length;
    viewed.normal = {-viewed.edge.y(), viewed.edge.x()};
    viewed.offset = viewed.normal.dot(from);
    if (std::abs(viewed.offset) < kNearest) return;  // seen edge-on
    viewed.along = wall.along_from - viewed.edge.dot(from);
    viewed.bottom = wall.bottom;
    viewed.top = wall.top;
    viewed.face = wall.face;
    viewed.shade = ShadeOf((wall.to - wall.from) / length);
    viewed.closes = wall.bottom <= 0.0 && wall.top >= world_.ceiling_height;
    viewed.spots = SpotsOn(wall, world_.lighting, view_);
    const Fragment fragment{static_cast<int>(scene_.walls.size()), -1, 0.0F, 1.0F};
    scene_.walls.push_back(std::move(viewed));
    AddFragments(grid_, RangeOf(from, to), fragment, scene_.columns);
  }

  void Add(const Slab& slab) {
    if (std::abs(slab.height - view_.height) < kNearest) return;  // seen edge-on
    ViewedSlab viewed{{}, slab.height, slab.colour};
    for (const Eigen::Vector2d& corner : slab.corners) viewed.corners.push_back(ToView(corner));
    if (IsInside(viewed.corners)) return;
    const Fragment fragment{-1, static_cast<int>(scene_.slabs.size()), 0.0F, 1.0F};
    AddFragments(grid_, RangeOf(viewed.corners), fragment, scene_.columns);
    scene_.slabs.push_back(std::move(viewed));
  }

  /// Walls of different directions are differently bright, so that corners are seen.
  static double ShadeOf(const Eigen::Vector2d& edge) {
    static const Eigen::Vector2d kLightFrom = Eigen::Vector2d(0.8, 0.6);
    return 0.84 + 0.16 * std::abs(edge.dot(kLightFrom));
  }

  const World& world_;
  const SceneView& view_;
  const BearingGrid& grid_;
  Eigen::Rotation2Dd view_from_world_;
  ViewedScene scene_;
};

}  // namespace

ViewedScene MakeViewedScene(const World& world, const SceneView& view, const BearingGrid& grid) {
  return SceneBuilder(world, view, grid).Build();
}

}  // namespace scan_image_slam
