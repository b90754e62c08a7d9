#include "scan_image_slam/core/baseline/core_slam.h"

#include "scan_image_slam/core/simulation/random_stream.h"

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

/// Distance from a place inside the room of 6 m x 4 m around (0.7, 0.3) to its wall.
double RangeInRoom(const Eigen::Vector2d& from, double angle) {
  const Eigen::Vector2d way(std::cos(angle), std::sin(angle));
  const double x = way.x() > 0 ? 3.7 : -2.3;
  const double y = way.y() > 0 ? 2.3 : -1.7;
  const double to_x = way.x() == 0.0 ? 1e9 : (x - from.x()) / way.x();
  const double to_y = way.y() == 0.0 ? 1e9 : (y - from.y()) / way.y();
  return std::min(to_x, to_y);
}

/// What a laser in the middle of the base sees of the room, one beam each degree.
CoreSlamScan ScanRoom(const Pose2& room_from_base, double seconds) {
  CoreSlamScan scan;
  scan.stamp = FromSeconds(seconds);
  scan.beam_spacing = M_PI / 180.0;
  for (int i = 0; i < 360; ++i) {
    const double bearing = i * M_PI / 180.0;
    const double range = RangeInRoom(room_from_base.translation(), room_from_base.theta + bearing);
    scan.hits.push_back(range * Eigen::Vector2d(std::cos(bearing), std::sin(bearing)));
  }
  return scan;
}

/// As that of the original, but the map is new at once, so that one scan is enough to match with.
CoreSlamOptions QuickToLearn() {
  CoreSlamOptions options;
  options.quality = 256;
  return options;
}

std::function<double()> Seeded(std::uint64_t seed) {
  return [random = std::make_shared<RandomStream>(seed, "test")] { return random->Normal(); };
}

TEST(CoreSlam, StartsAtTheOrigin) {
  CoreSlam slam(CoreSlamOptions(), Seeded(1));
  const Pose2 pose = slam.Add(ScanRoom({0.5, 0.2, 0.1}, 0.0), Pose2{3.0, 4.0, 1.0});
  EXPECT_EQ(pose.x, 0.0);
  EXPECT_EQ(pose.y, 0.0);
  EXPECT_EQ(pose.theta, 0.0);
}

TEST(CoreSlam, FindsAMotionThatTheOdometryDoesNotKnow) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    CoreSlam slam(QuickToLearn(), Seeded(seed));
    slam.Add(ScanRoom({}, 0.0), std::nullopt);
    const Pose2 pose = slam.Add(ScanRoom({0.08, -0.05, 0.1}, 0.1), std::nullopt);
    EXPECT_NEAR(pose.x, 0.08, 0.02);
    EXPECT_NEAR(pose.y, -0.05, 0.02);
    EXPECT_NEAR(pose.theta, 0.1, 0.01);
  }
}

TEST(CoreSlam, SearchesAroundTheOdometry) {
  // Too far for the search, but the odometry tells it, in a frame of its own.
  const Pose2 motion{0.9, 0.4, 0.6};
  const Pose2 odom_from_first{5.0, -3.0, 2.0};
  CoreSlam slam(QuickToLearn(), Seeded(1));
  slam.Add(ScanRoom({}, 0.0), odom_from_first);
  const Pose2 pose = slam.Add(ScanRoom(motion, 0.1), odom_from_first * motion);
  EXPECT_NEAR(pose.x, motion.x, 0.02);
  EXPECT_NEAR(pose.y, motion.y, 0.02);
  EXPECT_NEAR(pose.theta, motion.theta, 0.01);
}

TEST(CoreSlam, DistanceIsTheMeanOfTheMapUnderTheHits) {
  CoreSlamOptions options = QuickToLearn();
  options.rays_per_beam = 1;
  CoreSlam slam(options, Seeded(1));
  CoreSlamScan scan;
  scan.beam_spacing = 0.01;
  scan.hits = {{2.005, 0.005}};
  slam.Add(scan, std::nullopt);
  EXPECT_NEAR(slam.Distance(scan, Pose2()), HoleMap::kObstacle, 0.02 * HoleMap::kFree);
  // One hit half up the hole (0.15 m of 0.3 m), one in the open, one where nothing is known.
  scan.hits = {{1.855, 0.005}, {1.005, 0.005}, {1.005, 5.0}};
  const double expected = (0.5 * HoleMap::kFree + HoleMap::kFree + HoleMap::kUnknown) / 3.0;
  EXPECT_NEAR(slam.Distance(scan, Pose2()), expected, 0.02 * HoleMap::kFree);
}

TEST(CoreSlam, NeverEndsWorseThanItBegan) {
  CoreSlam slam(QuickToLearn(), Seeded(7));
  slam.Add(ScanRoom({}, 0.0), Pose2());
  const CoreSlamScan scan = ScanRoom({0.2, 0.1, -0.2}, 0.1);
  const double at_odometry = slam.Distance(scan, {0.1, 0.1, -0.1});
  CoreSlamOptions frozen = QuickToLearn();
  frozen.update_period = 1.0;  // the map stays as it was, so that distances can be compared
  CoreSlam other(frozen, Seeded(7));
  other.Add(ScanRoom({}, 0.0), Pose2());
  const Pose2 pose = other.Add(scan, Pose2{0.1, 0.1, -0.1});
  EXPECT_LT(other.Distance(scan, pose), at_odometry);
}

TEST(CoreSlam, GivesUpAfterTheAllowedFailures) {
  CoreSlamOptions options = QuickToLearn();
  options.sigma_distance = 0.0;  // every try is the start again, and so a failure
  options.sigma_angle = 0.0;
  options.max_failures = 37;
  CoreSlam slam(options, Seeded(1));
  slam.Add(ScanRoom({}, 0.0), std::nullopt);
  EXPECT_EQ(slam.tries(), 0);
  slam.Add(ScanRoom({}, 0.1), std::nullopt);
  EXPECT_EQ(slam.tries(), 37);
}

TEST(CoreSlam, DrawsNoMoreOftenThanAsked) {
  CoreSlamOptions options = QuickToLearn();
  options.update_period = 0.5;
  options.max_failures = 0;  // no search: the pose is the odometry's
  CoreSlam slam(options, Seeded(1));
  slam.Add(ScanRoom({}, 0.0), Pose2());
  const Eigen::Vector2d wall(3.695, 0.005);
  const std::uint16_t before = slam.map().At(wall);
  const Pose2 moved{0.1, 0.0, 0.0};  // with a scan that does not show it: the walls move along
  slam.Add(ScanRoom({}, 0.4), moved);
  EXPECT_EQ(slam.map().At(wall), before);
  slam.Add(ScanRoom({}, 0.5), moved);
  EXPECT_NE(slam.map().At(wall), before);
}

TEST(CoreSlam, IsTheSameWithTheSameSeedOnly) {
  const auto run = [](std::uint64_t seed) {
    CoreSlam slam(QuickToLearn(), Seeded(seed));
    slam.Add(ScanRoom({}, 0.0), Pose2());
    return slam.Add(ScanRoom({0.08, -0.05, 0.1}, 0.1), Pose2());
  };
  EXPECT_EQ(run(1).x, run(1).x);
  EXPECT_EQ(run(1).theta, run(1).theta);
  EXPECT_NE(run(1).x, run(2).x);
}

TEST(ToCoreSlamScan, TakesTheHitsFromTheMinimumOn) {
  FusedModel model;
  model.stamp = 42;
  model.base_from_laser = {0.2, 0.1, 0.0};
  for (const double range : {0.29, 0.31, std::numeric_limits<double>::infinity(), 5.0}) {
    ModelBeam beam;
    beam.bearing = 0.1 * static_cast<double>(model.beams.size());
    beam.range = range;
    beam.point = {range, 1.0};
    model.beams.push_back(beam);
  }
  const CoreSlamScan scan = ToCoreSlamScan(model, 0.3);
  EXPECT_EQ(scan.stamp, 42);
  EXPECT_EQ(scan.origin, Eigen::Vector2d(0.2, 0.1));
  EXPECT_NEAR(scan.beam_spacing, 0.1, 1e-12);
  ASSERT_EQ(scan.hits.size(), 2u);
  EXPECT_EQ(scan.hits[0], Eigen::Vector2d(0.31, 1.0));
  EXPECT_EQ(scan.hits[1], Eigen::Vector2d(5.0, 1.0));
}

TEST(CoreSlamOptions, RefusesValuesOutOfRange) {
  CoreSlamOptions options;
  options.rays_per_beam = 0;
  EXPECT_THROW(options.Validate(), std::invalid_argument);
  options = {};
  options.max_failures = -1;
  EXPECT_THROW(CoreSlam(options, Seeded(1)), std::invalid_argument);
}

}  // namespace
}  // namespace scan_image_slam
