#include "scan_image_slam/core/mapping/score_pyramid.h"

#include <algorithm>
#include <cmath>

namespace scan_image_slam {
namespace {

using Grid = std::vector<std::uint8_t>;

/// From blocks of n cells to blocks of 2n: the largest of two neighbours, in both directions.
Grid DoubleBlocks(const Grid& grid, int width, int height, int block) {
  const int wider = width + block;
  const int higher = height + block;
  Grid rows(static_cast<std::size_t>(wider) * height);
  for (int y = 0; y < height; ++y) {
    const std::uint8_t* in = grid.data() + static_cast<std::size_t>(y) * width;
    std::uint8_t* out = rows.data() + static_cast<std::size_t>(y) * wider;
    for (int x = 0; x < wider; ++x) {
      const std::uint8_t left = x >= block ? in[x - block] : 0;
      const std::uint8_t right = x < width ? in[x] : 0;
      out[x] = std::max(left, right);
    }
  }
  Grid result(static_cast<std::size_t>(wider) * higher);
  for (int y = 0; y < higher; ++y) {
    const std::uint8_t* below =
        y >= block ? rows.data() + static_cast<std::size_t>(y - block) * wider : nullptr;
    const std::uint8_t* above =
        y < height ? rows.data() + static_cast<std::size_t>(y) * wider : nullptr;
    std::uint8_t* out = result.data() + static_cast<std::size_t>(y) * wider;
    for (int x = 0; x < wider; ++x) {
      out[x] = std::max(below ? below[x] : std::uint8_t{0}, above ? above[x] : std::uint8_t{0});
    }
  }
  return result;
}

/// The points, turned, in cells.
struct TurnedPoints {
  double angle = 0.0;
  std::vector<Eigen::Vector2i> cells;
};

/// A block of 2^level x 2^level offsets of the turned points, and the bound of its score.
struct Block {
  int level = 0;
  int turn = 0;
  int x = 0;
  int y = 0;
  int bound = 0;
};

class Search {
 public:
  Search(const ScorePyramid& pyramid, const std::vector<Eigen::Vector2d>& points,
         const PoseWindow& window, double angle_step,
         const std::optional<SearchExclusion>& exclusion)
      : pyramid_(pyramid), window_(window), exclusion_(exclusion) {
    half_cells_ = static_cast<int>(std::floor(window.half_distance / pyramid.cell_size()));
    const int turns = static_cast<int>(std::floor(window.half_angle / angle_step));
    for (int i = -turns; i <= turns; ++i) {
      TurnedPoints turned;
      turned.angle = window.centre.theta + i * angle_step;
      const RigidTransform2 transform(Pose2{window.centre.x, window.centre.y, turned.angle});
      turned.cells.reserve(points.size());
      for (const Eigen::Vector2d& p : points) turned.cells.push_back(pyramid.CellOf(transform * p));
      turned_.push_back(std::move(turned));
    }
  }

  /// Depth first, best bound first (Hess et al. 2016, algorithm 3).
  std::optional<ScoredPose> Run(double min_score) {
    const double full = 255.0 * static_cast<double>(turned_.front().cells.size());
    best_bound_ = static_cast<int>(std::floor(min_score * full));
    const int top = pyramid_.levels() - 1;
    std::vector<Block> blocks;
    for (int t = 0; t < static_cast<int>(turned_.size()); ++t) {
      for (int x = -half_cells_; x <= half_cells_; x += 1 << top) {
        for (int y = -half_cells_; y <= half_cells_; y += 1 << top) {
          blocks.push_back(Bounded({top, t, x, y, 0}));
        }
      }
    }
    Visit(&blocks);
    if (!best_) return std::nullopt;
    return ScoredPose{PoseOf(*best_), best_->bound / full};
  }

 private:
  Block Bounded(Block block) const {
    for (const Eigen::Vector2i& cell : turned_[block.turn].cells) {
      block.bound += pyramid_.Bound(block.level, cell.x() + block.x, cell.y() + block.y);
    }
    return block;
  }

  Pose2 PoseOf(const Block& block) const {
    return {window_.centre.x + block.x * pyramid_.cell_size(),
            window_.centre.y + block.y * pyramid_.cell_size(),
            NormalizeAngle(turned_[block.turn].angle)};
  }

  bool Excluded(const Block& block) const {
    if (!exclusion_) return false;
    const Pose2 offset = exclusion_->pose.Inverse() * PoseOf(block);
    return offset.translation().norm() < exclusion_->distance &&
           std::abs(offset.theta) < exclusion_->angle;
  }

  void Visit(std::vector<Block>* blocks) {
    std::stable_sort(blocks->begin(), blocks->end(),
                     [](const Block& a, const Block& b) { return a.bound > b.bound; });
    for (const Block& block : *blocks) {
      if (block.bound <= best_bound_) return;
      if (block.level == 0) {
        if (Excluded(block)) continue;
        best_ = block;
        best_bound_ = block.bound;
        return;
      }
      const int half = 1 << (block.level - 1);
      std::vector<Block> children;
      for (const int dx : {0, half}) {
        for (const int dy : {0, half}) {
          if (block.x + dx > half_cells_ || block.y + dy > half_cells_) continue;
          children.push_back(Bounded({block.level - 1, block.turn, block.x + dx, block.y + dy, 0}));
        }
      }
      Visit(&children);
    }
  }

  const ScorePyramid& pyramid_;
  PoseWindow window_;
  std::optional<SearchExclusion> exclusion_;
  int half_cells_ = 0;
  std::vector<TurnedPoints> turned_;
  int best_bound_ = 0;
  std::optional<Block> best_;
};

}  // namespace

ScorePyramid::ScorePyramid(const std::vector<Eigen::Vector2d>& places,
                           const ScorePyramidOptions& options)
    : options_(options) {
  if (places.empty()) {
    levels_.assign(1, Grid());
    return;
  }
  Eigen::Vector2d lower = places.front();
  Eigen::Vector2d upper = places.front();
  for (const Eigen::Vector2d& p : places) {
    lower = lower.cwiseMin(p);
    upper = upper.cwiseMax(p);
  }
  const int margin = static_cast<int>(std::ceil(options_.reach / options_.cell_size)) + 1;
  origin_ = lower - margin * options_.cell_size * Eigen::Vector2d::Ones();
  const Eigen::Vector2i last = CellOf(upper);
  width_ = last.x() + margin + 1;
  height_ = last.y() + margin + 1;
  Grid grid(static_cast<std::size_t>(width_) * height_, 0);
  for (const Eigen::Vector2d& p : places) {
    const Eigen::Vector2i centre = CellOf(p);
    for (int y = centre.y() - margin + 1; y < centre.y() + margin; ++y) {
      for (int x = centre.x() - margin + 1; x < centre.x() + margin; ++x) {
        const Eigen::Vector2d cell =
            origin_ + options_.cell_size * Eigen::Vector2d(x + 0.5, y + 0.5);
        const double score = 1.0 - (cell - p).norm() / options_.reach;
        if (score <= 0.0) continue;
        std::uint8_t& value = grid[static_cast<std::size_t>(y) * width_ + x];
        value = std::max(value, static_cast<std::uint8_t>(std::lround(255.0 * score)));
      }
    }
  }
  levels_.push_back(std::move(grid));
  int width = width_;
  int height = height_;
  for (int level = 1; level < options_.levels; ++level) {
    const int block = 1 << (level - 1);
    levels_.push_back(DoubleBlocks(levels_.back(), width, height, block));
    width += block;
    height += block;
  }
}

std::optional<ScoredPose> SearchBest(const ScorePyramid& pyramid,
                                     const std::vector<Eigen::Vector2d>& points,
                                     const PoseWindow& window, double angle_step, double min_score,
                                     const std::optional<SearchExclusion>& exclusion) {
  if (points.empty()) return std::nullopt;
  return Search(pyramid, points, window, angle_step, exclusion).Run(min_score);
}

}  // namespace scan_image_slam
