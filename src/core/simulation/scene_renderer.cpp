#include "scan_image_slam/core/simulation/scene_renderer.h"

#include "column_painter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <opencv2/core/fast_math.hpp>

namespace scan_image_slam {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A surface in a strip, with the horizontal distances between which it is seen.
struct Seen {
  const ViewedWall* wall = nullptr;
  const ViewedSlab* slab = nullptr;
  double near = 0.0;
  double far = 0.0;
};

/// Where a ray enters and leaves a convex outline; near > far if it misses.
Seen Cut(const ViewedSlab& slab, const Eigen::Vector2d& ray) {
  Seen seen{nullptr, &slab, kInfinity, 0.0};
  for (std::size_t i = 0; i < slab.corners.size(); ++i) {
    const Eigen::Vector2d& from = slab.corners[i];
    const Eigen::Vector2d edge = slab.corners[(i + 1) % slab.corners.size()] - from;
    const double slant = Cross(ray, edge);
    const double s = Cross(from, ray) / slant;
    if (!(s >= 0.0 && s <= 1.0)) continue;  // also if parallel
    const double distance = Cross(from, edge) / slant;
    seen.near = std::min(seen.near, distance);
    seen.far = std::max(seen.far, distance);
  }
  return seen;
}

template <typename Pixel>
class ColumnRenderer : public SceneRenderer {
 public:
  ColumnRenderer(const World& world, const BearingGrid& grid)
      : world_(world),
        grid_(grid),
        textures_(world),
        painter_(world_, grid_, textures_),
        planes_(grid.rows),
        part_(grid.rows),
        image_(grid.columns, grid.rows, sizeof(Pixel) == 1 ? CV_8UC1 : CV_8UC4) {}

  const cv::Mat& Render(const SceneView& view) override {
    scene_ = MakeViewedScene(world_, view, grid_);
    painter_.Begin(view);
    for (int j = 0; j < grid_.columns; ++j) RenderColumn(j, image_.ptr<Pixel>(j));
    return image_;
  }

 private:
  /// Where something begins or ends inside the column, the parts are drawn apart and averaged.
  void RenderColumn(int j, Pixel* column) {
    const double closing = KeepVisible(j);
    painter_.PaintPlanes(StripOf(j, 0.0F, 1.0F), closing, column);
    FindCuts();
    if (cuts_.size() == 2) {
      RenderPart(StripOf(j, 0.0F, 1.0F), 0.5F, column);
      return;
    }
    std::copy(column, column + grid_.rows, planes_.data());
    float done = 0.0F;
    for (std::size_t i = 0; i + 1 < cuts_.size(); ++i) {
      const float begin = cuts_[i];
      const float end = cuts_[i + 1];
      std::copy(planes_.begin(), planes_.end(), part_.begin());
      RenderPart(StripOf(j, begin, end), 0.5F * (begin + end), part_.data());
      done += end - begin;
      const auto weight = static_cast<std::uint32_t>(cvRound(256.0F * (end - begin) / done));
      for (int row = 0; row < grid_.rows; ++row) {
        column[row] = PixelOps<Pixel>::Blend(column[row], part_[row], weight);
      }
    }
  }

  Strip StripOf(int j, float begin, float end) const {
    return {grid_.Ray(j + begin), grid_.Ray(j + 0.5F * (begin + end)), grid_.Ray(j + end)};
  }

  /// Distances at which a wall is seen at the two ends of a fragment of column j.
  std::pair<double, double> DistancesOf(const Fragment& fragment, int j) const {
    const ViewedWall& wall = scene_.walls[fragment.wall];
    const double a = wall.offset / wall.normal.dot(grid_.Ray(j + fragment.begin));
    const double b = wall.offset / wall.normal.dot(grid_.Ray(j + fragment.end));
    return {a, b};
  }

  /// Leaves out walls of column j that are hidden in its whole width, because they would cut it for
  /// nothing. Returns the farthest distance of what hides them, +Inf if there is nothing.
  double KeepVisible(int j) {
    visible_ = scene_.columns[j];
    double closing = kInfinity;
    for (const Fragment& fragment : visible_) {
      const bool whole = fragment.begin <= 0.0F && fragment.end >= 1.0F;
      if (!whole || fragment.wall < 0 || !scene_.walls[fragment.wall].closes) continue;
      const auto [a, b] = DistancesOf(fragment, j);
      if (a > 0.0 && b > 0.0) closing = std::min(closing, std::max(a, b));
    }
    const auto hidden = [&](const Fragment& fragment) {
      if (fragment.wall < 0) return false;
      const auto [a, b] = DistancesOf(fragment, j);
      return a > closing && b > closing;
    };
    visible_.erase(std::remove_if(visible_.begin(), visible_.end(), hidden), visible_.end());
    return closing;
  }

  /// The borders of the parts of a column in which the same things are seen.
  void FindCuts() {
    constexpr float kThinnest = 1.0F / 128;  // of a column
    cuts_.clear();
    for (const Fragment& fragment : visible_) {
      for (const float cut : {fragment.begin, fragment.end}) {
        if (cut > kThinnest && cut < 1.0F - kThinnest) cuts_.push_back(cut);
      }
    }
    cuts_.push_back(0.0F);
    cuts_.push_back(1.0F);
    std::sort(cuts_.begin(), cuts_.end());
    const auto close = [](float a, float b) { return b - a < kThinnest; };
    cuts_.erase(std::unique(cuts_.begin(), cuts_.end(), close), cuts_.end());
  }

  /// Draws what is seen at `at`, a fraction of the column, over the planes.
  void RenderPart(const Strip& strip, float at, Pixel* column) {
    FindSurfaces(at, strip.middle);
    SortSurfaces();
    for (const Seen& seen : seen_) {
      if (seen.wall != nullptr) {
        painter_.PaintWall(strip, *seen.wall, seen.far, column);
      } else {
        painter_.PaintSlab(strip, *seen.slab, seen.near, seen.far, column);
      }
    }
  }

  void FindSurfaces(float at, const Eigen::Vector2d& ray) {
    seen_.clear();
    for (const Fragment& fragment : visible_) {
      if (fragment.begin > at || fragment.end < at) continue;
      if (fragment.wall >= 0) {
        const ViewedWall& wall = scene_.walls[fragment.wall];
        const double distance = wall.offset / wall.normal.dot(ray);
        if (distance > 0.0 && std::isfinite(distance)) {
          seen_.push_back({&wall, nullptr, distance, distance});
        }
      } else {
        const Seen seen = Cut(scene_.slabs[fragment.slab], ray);
        if (seen.near > 0.0 && seen.near < seen.far) seen_.push_back(seen);
      }
    }
  }

  /// Leaves out what the nearest closing wall hides and sorts the rest, farthest first. A slab
  /// counts by its far end, so that what stands on it comes later.
  void SortSurfaces() {
    double closing = kInfinity;
    for (const Seen& seen : seen_) {
      if (seen.wall != nullptr && seen.wall->closes) closing = std::min(closing, seen.far);
    }
    seen_.erase(std::remove_if(seen_.begin(), seen_.end(),
                               [&](const Seen& seen) {
                                 return seen.wall != nullptr ? seen.far > closing
                                                             : seen.near >= closing;
                               }),
                seen_.end());
    for (Seen& seen : seen_) {
      if (seen.slab != nullptr) seen.far = std::min(seen.far, closing) * (1.0 - 1e-9);
    }
    std::sort(seen_.begin(), seen_.end(),
              [](const Seen& a, const Seen& b) { return a.far > b.far; });
  }

  const World& world_;
  const BearingGrid grid_;
  TextureSet<Pixel> textures_;
  ColumnPainter<Pixel> painter_;
  ViewedScene scene_;
  std::vector<Pixel> planes_;
  std::vector<Pixel> part_;
  std::vector<Fragment> visible_;
  std::vector<float> cuts_;
  std::vector<Seen> seen_;
  cv::Mat image_;
};

}  // namespace

std::unique_ptr<SceneRenderer> MakeSceneRenderer(const World& world, const BearingGrid& grid,
                                                 bool colour) {
  if (colour) return std::make_unique<ColumnRenderer<std::uint32_t>>(world, grid);
  return std::make_unique<ColumnRenderer<std::uint8_t>>(world, grid);
}

}  // namespace scan_image_slam
