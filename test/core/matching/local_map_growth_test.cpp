// Which scans the matcher lets into its map.
#include "scan_image_slam/core/matching/local_map_matcher.h"
#include "support_rooms.h"

#include <cmath>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

const Pose2 kOrigin;

MotionPrediction Predicted(const Pose2& motion) {
  MotionPrediction prediction;
  prediction.motion = motion;
  prediction.dt = 0.1;
  prediction.from_encoders = true;
  prediction.window = {0.1, 0.05, 0.05};
  prediction.covariance = Eigen::Matrix3d::Identity();
  return prediction;
}

FusedModel SeenFrom(const Pose2& pose) { return ModelOf(SeparateWalls(), pose, 1, TestLaser()); }

/// How much is known of the walls: grows with every scan that enters.
double Knowledge(const LocalMapMatcher& matcher) {
  double sum = 0.0;
  for (const SurfaceElement& e : matcher.local_map().elements()) {
    sum += static_cast<double>(e.information);
  }
  return sum;
}

/// Matches a scan at a pose that was predicted rightly; true if it entered the map.
bool Enters(LocalMapMatcher* matcher, const Pose2& pose) {
  const double before = Knowledge(*matcher);
  matcher->Match(SeenFrom(pose), kOrigin, Predicted(pose));
  return Knowledge(*matcher) > before;
}

LocalMapMatcher Started(int insert_first) {
  LocalMapMatcherOptions options;
  options.insert_first = insert_first;
  options.insert_distance = 0.05;
  options.insert_angle = 0.04;
  LocalMapMatcher matcher(options);
  matcher.Start(SeenFrom(kOrigin), kOrigin);
  return matcher;
}

TEST(LocalMapGrowth, TakesTheFirstScansInAnyCase) {
  LocalMapMatcher matcher = Started(3);
  EXPECT_GT(Knowledge(matcher), 0.0);
  EXPECT_TRUE(Enters(&matcher, kOrigin));
  EXPECT_TRUE(Enters(&matcher, kOrigin));
  EXPECT_FALSE(Enters(&matcher, kOrigin));
}

TEST(LocalMapGrowth, TakesAScanWhenTheRobotHasMoved) {
  LocalMapMatcher matcher = Started(1);
  EXPECT_FALSE(Enters(&matcher, {0.049, 0.0, 0.0}));
  EXPECT_TRUE(Enters(&matcher, {0.051, 0.0, 0.0}));
  EXPECT_FALSE(Enters(&matcher, {0.1, 0.0, 0.0}));  // from the last scan that entered
  EXPECT_TRUE(Enters(&matcher, {0.102, 0.0, 0.0}));
}

TEST(LocalMapGrowth, TakesAScanWhenTheRobotHasTurned) {
  LocalMapMatcher matcher = Started(1);
  EXPECT_FALSE(Enters(&matcher, {0.0, 0.0, -0.039}));
  EXPECT_TRUE(Enters(&matcher, {0.0, 0.0, -0.041}));
  EXPECT_FALSE(Enters(&matcher, {0.0, 0.0, -0.08}));
}

TEST(LocalMapGrowth, LeavesOutAScanWhosePredictionWasOffByMoreThanTheWindow) {
  LocalMapMatcher matcher = Started(10);
  const double before = Knowledge(matcher);
  const MatchOutcome outcome =
      matcher.Match(SeenFrom(kOrigin), kOrigin, Predicted({0.0, 0.0, 0.08}));
  EXPECT_TRUE(outcome.on_window_edge);
  EXPECT_EQ(Knowledge(matcher), before);
}

TEST(LocalMapGrowth, LeavesOutAScanThatShowsTooLittleOfTheMap) {
  // One of two walls is known: half of the points. A wall's end is matched up to its along gate.
  const Room known{{{2.0, -1.0}, {2.0, 1.0}}};
  const Room both = known + Room{{{-2.0, -1.0}, {-2.0, 1.0}}};
  for (const double fraction : {0.4, 0.6}) {
    LocalMapMatcherOptions options;
    options.min_matched_fraction = fraction;
    LocalMapMatcher matcher(options);
    matcher.Start(ModelOf(known, kOrigin, 0, TestLaser()), kOrigin);
    const double before = Knowledge(matcher);
    const MatchOutcome outcome =
        matcher.Match(ModelOf(both, kOrigin, 1, TestLaser()), kOrigin, Predicted(kOrigin));
    EXPECT_EQ(2 * outcome.matched, outcome.points);
    EXPECT_EQ(Knowledge(matcher) > before, fraction < 0.5);
  }
}

TEST(LocalMapGrowth, PlacesTheScanWhereItWasFound) {
  // What was hidden before is seen from the new place, and lies where it lies in the room.
  const Room wall{
      {{2.0, -3.0}, {2.0, 3.0}}, {{-2.0, -3.0}, {-2.0, 3.0}}, {{-1.0, 2.5}, {1.0, 2.5}}};
  TestLaser short_sighted;
  short_sighted.max_range = 2.8;
  LocalMapMatcherOptions options;
  LocalMapMatcher matcher(options);
  matcher.Start(ModelOf(wall, kOrigin, 0, short_sighted), kOrigin);
  const std::size_t size = matcher.local_map().elements().size();
  const Pose2 pose{0.0, 0.4, 0.2};
  matcher.Match(ModelOf(wall, pose, 1, short_sighted), kOrigin,
                Predicted(pose * Pose2{0.02, -0.01, 0.02}));
  EXPECT_GT(matcher.local_map().elements().size(), size);
  for (const SurfaceElement& e : matcher.local_map().elements()) {
    const double off = std::min(std::abs(std::abs(e.position.x()) - 2.0),
                                std::abs(static_cast<double>(e.position.y()) - 2.5));
    EXPECT_LT(off, 1e-4) << e.position.transpose();
  }
}

TEST(LocalMapGrowth, StartsLaterIfTheFirstScanIsEmpty) {
  LocalMapMatcher matcher{LocalMapMatcherOptions()};
  matcher.Start(ModelOf({}, kOrigin, 0, TestLaser()), kOrigin);
  EXPECT_TRUE(Enters(&matcher, kOrigin));
}

TEST(LocalMapGrowth, GrowsWithoutRefinement) {
  LocalMapMatcherOptions options;
  options.refinement.max_iterations = 0;
  LocalMapMatcher matcher(options);
  matcher.Start(SeenFrom(kOrigin), kOrigin);
  EXPECT_TRUE(Enters(&matcher, kOrigin));
}

}  // namespace
}  // namespace scan_image_slam
