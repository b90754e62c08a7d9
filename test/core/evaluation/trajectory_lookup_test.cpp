#include "scan_image_slam/core/evaluation/trajectory_lookup.h"

#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

const Trajectory kTrajectory{{FromSeconds(1.0), {0.0, 0.0, 0.0}},
                             {FromSeconds(1.2), {2.0, 0.0, 0.0}},
                             {FromSeconds(3.2), {2.0, 4.0, 1.0}}};

std::optional<Pose2> At(double seconds, const LookupLimits& limits = {0.5, 0.01}) {
  return PoseAt(kTrajectory, FromSeconds(seconds), limits);
}

TEST(PoseAt, InterpolatesBetweenPosesThatAreClose) {
  const std::optional<Pose2> pose = At(1.05);
  ASSERT_TRUE(pose);
  EXPECT_NEAR(pose->x, 0.5, 1e-12);
  EXPECT_NEAR(pose->y, 0.0, 1e-12);
}

TEST(PoseAt, ReturnsAPoseAtItsOwnTime) {
  for (const StampedPose& expected : kTrajectory) {
    const std::optional<Pose2> pose = PoseAt(kTrajectory, expected.stamp, {0.0, 0.0});
    ASSERT_TRUE(pose);
    EXPECT_DOUBLE_EQ(pose->x, expected.pose.x);
    EXPECT_DOUBLE_EQ(pose->y, expected.pose.y);
  }
}

TEST(PoseAt, DoesNotInterpolateAcrossAGap) {
  EXPECT_FALSE(At(2.2));
  EXPECT_TRUE(At(2.2, {2.1, 0.01}));
}

TEST(PoseAt, TakesTheNearestPoseInAGap) {
  ASSERT_TRUE(At(1.209));
  EXPECT_DOUBLE_EQ(At(1.209)->y, 0.0);
  ASSERT_TRUE(At(3.191));
  EXPECT_DOUBLE_EQ(At(3.191)->y, 4.0);
  EXPECT_FALSE(At(1.211));
  EXPECT_FALSE(At(3.189));
}

TEST(PoseAt, NeverExtrapolates) {
  ASSERT_TRUE(At(0.991));
  EXPECT_DOUBLE_EQ(At(0.991)->x, 0.0);
  ASSERT_TRUE(At(3.209));
  EXPECT_DOUBLE_EQ(At(3.209)->theta, 1.0);
  EXPECT_FALSE(At(0.98));
  EXPECT_FALSE(At(3.22));
  EXPECT_FALSE(PoseAt({}, 0, {1.0, 1.0}));
}

TEST(LookupLimits, RefusesNonsense) {
  EXPECT_NO_THROW((LookupLimits{0.0, 0.0}.Validate()));
  EXPECT_THROW((LookupLimits{-1.0, 0.0}.Validate()), std::invalid_argument);
  EXPECT_THROW((LookupLimits{1.0, std::nan("")}.Validate()), std::invalid_argument);
  EXPECT_THROW((LookupLimits{std::numeric_limits<double>::infinity(), 0.0}.Validate()),
               std::invalid_argument);
}

}  // namespace
}  // namespace scan_image_slam
