#include "scan_image_slam/core/mapping/score_pyramid.h"

#include "support_rooms.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

std::vector<Eigen::Vector2d> RandomPlaces(int count, double size, std::uint64_t seed) {
  TestRandom random(seed);
  std::vector<Eigen::Vector2d> places;
  for (int i = 0; i < count; ++i) {
    places.emplace_back(random.Uniform(-size, size), random.Uniform(-size, size));
  }
  return places;
}

ScorePyramidOptions Coarse() {
  ScorePyramidOptions options;
  options.cell_size = 0.1;
  options.reach = 0.25;
  options.levels = 4;
  return options;
}

TEST(ScorePyramid, ScoresFallWithTheDistanceToTheNearestPlace) {
  const ScorePyramid pyramid({{0.05, 0.05}}, Coarse());
  const Eigen::Vector2i cell = pyramid.CellOf({0.05, 0.05});
  // The origin of the cells lies so that the place may be anywhere in its cell.
  EXPECT_GT(pyramid.Bound(0, cell.x(), cell.y()), 255 * (1.0 - 0.0708 / 0.25) - 1);
  EXPECT_GT(pyramid.Bound(0, cell.x(), cell.y()), pyramid.Bound(0, cell.x() + 1, cell.y()));
  EXPECT_GT(pyramid.Bound(0, cell.x() + 1, cell.y()), pyramid.Bound(0, cell.x() + 2, cell.y()));
  EXPECT_EQ(pyramid.Bound(0, cell.x() + 4, cell.y()), 0);
}

TEST(ScorePyramid, BoundsAreTheLargestScoreOfTheirBlock) {
  const ScorePyramid pyramid(RandomPlaces(60, 2.0, 5), Coarse());
  for (int level = 1; level < pyramid.levels(); ++level) {
    const int size = 1 << level;
    int different = 0;
    for (int x = -size - 2; x < 60; ++x) {
      for (int y = -size - 2; y < 60; ++y) {
        int largest = 0;
        for (int i = 0; i < size; ++i) {
          for (int j = 0; j < size; ++j) {
            largest = std::max(largest, pyramid.Bound(0, x + i, y + j));
          }
        }
        different += pyramid.Bound(level, x, y) != largest;
      }
    }
    EXPECT_EQ(different, 0) << "blocks of level " << level;
  }
}

/// The same search without any bound.
std::optional<ScoredPose> TryAll(const ScorePyramid& pyramid,
                                 const std::vector<Eigen::Vector2d>& points,
                                 const PoseWindow& window, double angle_step,
                                 const std::optional<SearchExclusion>& exclusion) {
  std::optional<ScoredPose> best;
  const int cells = static_cast<int>(std::floor(window.half_distance / pyramid.cell_size()));
  const int turns = static_cast<int>(std::floor(window.half_angle / angle_step));
  for (int t = -turns; t <= turns; ++t) {
    const Pose2 turned{window.centre.x, window.centre.y, window.centre.theta + t * angle_step};
    for (int x = -cells; x <= cells; ++x) {
      for (int y = -cells; y <= cells; ++y) {
        const Pose2 pose{turned.x + x * pyramid.cell_size(), turned.y + y * pyramid.cell_size(),
                         NormalizeAngle(turned.theta)};
        if (exclusion) {
          const Pose2 offset = exclusion->pose.Inverse() * pose;
          if (offset.translation().norm() < exclusion->distance &&
              std::abs(offset.theta) < exclusion->angle) {
            continue;
          }
        }
        double sum = 0.0;
        for (const Eigen::Vector2d& p : points) {
          const Eigen::Vector2i cell = pyramid.CellOf(turned * p);
          sum += pyramid.Bound(0, cell.x() + x, cell.y() + y);
        }
        const double score = sum / (255.0 * static_cast<double>(points.size()));
        if (!best || score > best->score) best = ScoredPose{pose, score};
      }
    }
  }
  return best;
}

class SearchBestOfRandomMaps : public ::testing::TestWithParam<int> {};

TEST_P(SearchBestOfRandomMaps, IsAsGoodAsTryingAll) {
  const auto seed = static_cast<std::uint64_t>(GetParam());
  const ScorePyramid pyramid(RandomPlaces(80, 3.0, seed), Coarse());
  const std::vector<Eigen::Vector2d> points = RandomPlaces(25, 2.0, seed + 100);
  const PoseWindow window{{0.3, -0.2, 0.4}, 1.3, 0.5};
  const auto best = SearchBest(pyramid, points, window, 0.05, 0.0);
  const auto expected = TryAll(pyramid, points, window, 0.05, {});
  ASSERT_TRUE(best.has_value());
  EXPECT_DOUBLE_EQ(best->score, expected->score);
  const SearchExclusion exclusion{expected->map_from_base, 0.5, 0.2};
  const auto second = SearchBest(pyramid, points, window, 0.05, 0.0, exclusion);
  ASSERT_TRUE(second.has_value());
  EXPECT_DOUBLE_EQ(second->score, TryAll(pyramid, points, window, 0.05, exclusion)->score);
}

INSTANTIATE_TEST_SUITE_P(Seeds, SearchBestOfRandomMaps, ::testing::Range(1, 9));

TEST(SearchBest, FindsWhereAScanWasTaken) {
  const Room room = FurnishedRoom();
  const Pose2 truth{0.7, -0.4, 0.25};
  std::vector<Eigen::Vector2d> places;
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < 720; ++i) {
    const double heading = 2.0 * M_PI * i / 720;
    const double from_centre = CastRay(room, {0, 0}, heading);
    places.emplace_back(from_centre * std::cos(heading), from_centre * std::sin(heading));
    if (i % 8 != 0) continue;
    const double range = CastRay(room, truth.translation(), truth.theta + heading);
    points.emplace_back(range * std::cos(heading), range * std::sin(heading));
  }
  ScorePyramidOptions options;
  options.cell_size = 0.05;
  const auto best =
      SearchBest(ScorePyramid(places, options), points, {{0, 0, 0}, 2.0, 0.6}, 0.01, 0.3);
  ASSERT_TRUE(best.has_value());
  EXPECT_NEAR(best->map_from_base.x, truth.x, 0.05);
  EXPECT_NEAR(best->map_from_base.y, truth.y, 0.05);
  EXPECT_NEAR(best->map_from_base.theta, truth.theta, 0.011);
}

TEST(SearchBest, FindsNothingBelowTheLeastScore) {
  const ScorePyramid pyramid(RandomPlaces(10, 2.0, 3), Coarse());
  EXPECT_FALSE(SearchBest(pyramid, RandomPlaces(30, 2.0, 4), {{0, 0, 0}, 0.5, 0.1}, 0.05, 0.9));
  EXPECT_FALSE(SearchBest(pyramid, {}, {{0, 0, 0}, 0.5, 0.1}, 0.05, 0.0));
  EXPECT_FALSE(SearchBest(ScorePyramid({}, Coarse()), {{1, 0}}, {{0, 0, 0}, 0.5, 0.1}, 0.05, 0.0));
}

}  // namespace
}  // namespace scan_image_slam
