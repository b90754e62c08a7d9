// What a local map becomes over many scans.
#include "scan_image_slam/core/matching/local_map.h"
#include "support_rooms.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

const RangeNoise kUsualNoise;
const LocalMapOptions kOptions;

std::vector<SurfacePoint> ScanOfRoom(const Pose2& pose, double stddev, TestRandom* random) {
  TestLaser laser;
  laser.range_stddev = stddev;
  return EstimateSurface(ModelOf(SeparateWalls(), pose, 0, laser, random), SurfaceOptions(),
                         kUsualNoise);
}

TEST(LocalMapLearning, DoesNotGrowByTheSameScan) {
  LocalMap map(kOptions, kUsualNoise);
  map.Insert(ScanOfRoom({}, 0.0, nullptr), {});
  const std::size_t size = map.elements().size();
  for (int i = 0; i < 10; ++i) map.Insert(ScanOfRoom({}, 0.0, nullptr), {});
  EXPECT_EQ(map.elements().size(), size);
}

TEST(LocalMapLearning, StopsGrowingWhenAllIsSeen) {
  TestRandom random(3);
  LocalMap map(kOptions, kUsualNoise);
  const auto insert = [&](int scans) {
    for (int i = 0; i < scans; ++i) {
      const Pose2 pose{random.Uniform(-0.3, 0.3), random.Uniform(-0.3, 0.3),
                       random.Uniform(-3.0, 3.0)};
      map.Insert(ScanOfRoom(pose, 0.01, &random), pose);
    }
    return map.elements().size();
  };
  const std::size_t early = insert(100);
  EXPECT_LE(early, 2u * 288u);
  EXPECT_LE(insert(900), early + early / 20);
}

/// Root mean square distance of the elements from a wall that 100 scans with noise have seen [m].
double ErrorOfLearntWall(double range_stddev) {
  TestRandom random(4);
  LocalMap map(kOptions, kUsualNoise);
  TestLaser laser;
  laser.range_stddev = range_stddev;
  for (int i = 0; i < 100; ++i) {
    const auto model = ModelOf({{{2.0, -1.0}, {2.0, 1.0}}}, {}, 0, laser, &random);
    map.Insert(EstimateSurface(model, SurfaceOptions(), kUsualNoise), {});
  }
  double squares = 0.0;
  for (const SurfaceElement& e : map.elements()) squares += std::pow(e.position.x() - 2.0, 2);
  return std::sqrt(squares / static_cast<double>(map.elements().size()));
}

TEST(LocalMapLearning, LearnsAWallBetterThanOnePoint) {
  // Of some 80 points in each of 100 scans, one element sees hundreds: their mean must beat one.
  EXPECT_LT(ErrorOfLearntWall(0.005), 0.5 * 0.005);
  EXPECT_LT(ErrorOfLearntWall(0.01), 0.5 * 0.01);
}

TEST(LocalMapLearning, LearnsAWallBetterThanOnePointOfTheDefaultNoise) {
  EXPECT_LT(ErrorOfLearntWall(0.02), 0.5 * 0.02);
}

}  // namespace
}  // namespace scan_image_slam
