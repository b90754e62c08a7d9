#include "scan_image_slam/core/calibration/range_jump.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

constexpr double kStep = 0.01;  // between beams [rad]

/// Beams from -0.05 rad on, 1 ms apart.
FusedModel ModelOf(const std::vector<double>& ranges) {
  FusedModel model;
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    ModelBeam beam;
    beam.bearing = -0.05 + kStep * static_cast<double>(i);
    beam.range = ranges[i];
    beam.time_offset = 1e-3 * static_cast<double>(i);
    model.beams.push_back(beam);
  }
  return model;
}

TEST(RangeJump, LiesBetweenTheLastBeamOnTheNearSurfaceAndTheNext) {
  const auto jumps = FindRangeJumps(ModelOf({2, 2, 2, 4, 4, 4}), {});
  ASSERT_EQ(jumps.size(), 1U);
  EXPECT_NEAR(jumps[0].heading, -0.05 + 2.5 * kStep, 1e-12);
  EXPECT_DOUBLE_EQ(jumps[0].range, 2.0);
  EXPECT_DOUBLE_EQ(jumps[0].time_offset, 2e-3);
  EXPECT_EQ(jumps[0].side, 1);
  EXPECT_NEAR(jumps[0].stddev, kStep / std::sqrt(12.0), 1e-12);  // evenly between two beams
}

TEST(RangeJump, BelongsToTheNearSurfaceOnBothOfItsSides) {
  const auto jumps = FindRangeJumps(ModelOf({5, 5, 5, 2, 2, 2, 2, 5, 5, 5}), {});
  ASSERT_EQ(jumps.size(), 2U);
  EXPECT_EQ(jumps[0].side, -1);
  EXPECT_NEAR(jumps[0].heading, -0.05 + 2.5 * kStep, 1e-12);
  EXPECT_EQ(jumps[1].side, 1);
  EXPECT_NEAR(jumps[1].heading, -0.05 + 6.5 * kStep, 1e-12);
}

TEST(RangeJump, HasItsSideInTheBaseFrameForALaserUpsideDown) {
  FusedModel model = ModelOf({2, 2, 2, 4, 4, 4});
  model.upside_down = true;
  model.base_from_laser = {0.0, 0.0, 0.3};
  const auto jumps = FindRangeJumps(model, {});
  ASSERT_EQ(jumps.size(), 1U);
  EXPECT_EQ(jumps[0].side, -1);
  EXPECT_NEAR(jumps[0].heading, 0.3 + 0.05 - 2.5 * kStep, 1e-12);
}

TEST(RangeJump, BridgesOneBeamWhoseSpotLiesOnBothSurfaces) {
  const auto jumps = FindRangeJumps(ModelOf({2, 2, 2, 2.9, 4, 4, 4}), {});
  ASSERT_EQ(jumps.size(), 1U);
  EXPECT_NEAR(jumps[0].heading, -0.05 + 3.0 * kStep, 1e-12);
  EXPECT_NEAR(jumps[0].stddev, 2.0 * kStep / std::sqrt(12.0), 1e-12);
}

TEST(RangeJump, IsSeenBeforeNothingButNotBesideTheUnknown) {
  const double nothing = std::numeric_limits<double>::infinity();
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(FindRangeJumps(ModelOf({2, 2, 2, nothing, nothing}), {}).size(), 1U);
  EXPECT_TRUE(FindRangeJumps(ModelOf({2, 2, 2, unknown, unknown, 4, 4}), {}).empty());
}

TEST(RangeJump, IsNoneOnASlantedWallOrBesideASpeck) {
  std::vector<double> wall;  // a wall at x = 2 - y, seen under 45 degrees: no discontinuity
  for (int i = 0; i < 40; ++i) {
    const double bearing = -0.05 + kStep * i;
    wall.push_back(2.0 / (std::cos(bearing) + std::sin(bearing)));
  }
  EXPECT_TRUE(FindRangeJumps(ModelOf(wall), {}).empty());
  // Two beams are fewer than a surface has.
  EXPECT_TRUE(FindRangeJumps(ModelOf({4, 4, 4, 2, 2, 4, 4, 4}), {}).empty());
}

TEST(RangeJump, IsNotUsedFarAwayOrIfShallow) {
  RangeJumpOptions options;
  options.max_range = 1.9;
  EXPECT_TRUE(FindRangeJumps(ModelOf({2, 2, 2, 4, 4, 4}), options).empty());
  options.max_range = 2.0;
  EXPECT_EQ(FindRangeJumps(ModelOf({2, 2, 2, 4, 4, 4}), options).size(), 1U);
  options.min_depth = 2.1;
  EXPECT_TRUE(FindRangeJumps(ModelOf({2, 2, 2, 4, 4, 4}), options).empty());
}

}  // namespace
}  // namespace scan_image_slam
