#include "scan_image_slam/core/baseline/hole_map.h"

#include <algorithm>
#include <stdexcept>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

constexpr int kObstacle = HoleMap::kObstacle;
constexpr double kRounding = 2.0;
constexpr int kFree = HoleMap::kFree;
constexpr int kUnknown = HoleMap::kUnknown;

/// Cells of 0.1 m, a hole of 0.8 m; a new ray replaces what was there.
HoleMap ForgetfulMap() { return HoleMap(0.1, 0.8, 256); }

TEST(HoleMap, IsUnknownWhereNothingWasDrawn) {
  HoleMap map = ForgetfulMap();
  EXPECT_EQ(map.At({0, 0}), kUnknown);
  map.DrawRay({0.05, 0.05}, {2.05, 0.05});
  EXPECT_EQ(map.At({1.05, 0.15}), kUnknown);
  EXPECT_EQ(map.At({1e6, -1e6}), kUnknown);
}

TEST(HoleMap, DigsAHoleLikeAVAroundTheHit) {
  HoleMap map = ForgetfulMap();
  map.DrawRay({0.05, 0.05}, {2.05, 0.05});
  EXPECT_EQ(map.At({0.05, 0.05}), kFree);
  EXPECT_EQ(map.At({1.55, 0.05}), kFree);
  // Half the hole is 0.4 m: each cell of 0.1 m nearer to the hit is a quarter deeper.
  for (const double side : {-1.0, 1.0}) {
    for (int i = 0; i <= 3; ++i) {
      EXPECT_NEAR(map.At({2.05 + side * 0.1 * i, 0.05}), i * kFree / 4.0, kRounding) << side * i;
    }
  }
  EXPECT_EQ(map.At({2.55, 0.05}), kUnknown) << "nothing is known behind the hole";
}

TEST(HoleMap, DigsTheSameHoleInEveryDirection) {
  const Eigen::Vector2d origin(0.05, 0.05);
  for (const Eigen::Vector2d& way :
       {Eigen::Vector2d(0, 2), Eigen::Vector2d(-2, 0), Eigen::Vector2d(0, -2)}) {
    HoleMap map = ForgetfulMap();
    map.DrawRay(origin, origin + way);
    EXPECT_NEAR(map.At(origin + way), kObstacle, kRounding);
    EXPECT_NEAR(map.At(origin + 0.9 * way), kFree / 2.0, kRounding);
    EXPECT_NEAR(map.At(origin + 1.1 * way), kFree / 2.0, kRounding);
    EXPECT_EQ(map.At(origin + 0.5 * way), kFree);
  }
}

TEST(HoleMap, BlendsByQuality) {
  HoleMap map(0.1, 0.8, 64);  // a quarter of the new, three quarters of the old
  map.DrawRay({0.05, 0.05}, {2.05, 0.05});
  EXPECT_NEAR(map.At({1.05, 0.05}), 0.75 * kUnknown + 0.25 * kFree, kRounding);
  EXPECT_NEAR(map.At({2.05, 0.05}), 0.75 * kUnknown + 0.25 * kObstacle, kRounding);
  map.DrawRay({0.05, 0.05}, {2.05, 0.05});
  EXPECT_NEAR(map.At({2.05, 0.05}), 0.75 * 0.75 * kUnknown, kRounding);
}

TEST(HoleMap, KeepsItsContentWhenItGrows) {
  HoleMap map = ForgetfulMap();
  map.DrawRay({0.05, 0.05}, {2.05, 0.05});
  map.DrawRay({0.05, 0.05}, {0.05, -40.05});
  map.DrawRay({0.05, 0.05}, {-40.05, 0.05});
  map.DrawRay({0.05, 0.05}, {0.05, 40.05});
  map.DrawRay({5.05, 5.05}, {40.05, 5.05});
  EXPECT_NEAR(map.At({2.05, 0.05}), kObstacle, kRounding);
  EXPECT_NEAR(map.At({0.05, -40.05}), kObstacle, kRounding);
  EXPECT_NEAR(map.At({-40.05, 0.05}), kObstacle, kRounding);
  EXPECT_NEAR(map.At({0.05, 40.05}), kObstacle, kRounding);
  EXPECT_NEAR(map.At({40.05, 5.05}), kObstacle, kRounding);
  EXPECT_EQ(map.At({20.05, 5.05}), kFree);
}

TEST(HoleMap, RefusesOptionsOutOfRange) {
  EXPECT_THROW(HoleMap(0.0, 0.6, 50), std::invalid_argument);
  EXPECT_THROW(HoleMap(0.1, 0.0, 50), std::invalid_argument);
  EXPECT_THROW(HoleMap(0.1, 0.6, 0), std::invalid_argument);
  EXPECT_THROW(HoleMap(0.1, 0.6, 257), std::invalid_argument);
}

}  // namespace
}  // namespace scan_image_slam
