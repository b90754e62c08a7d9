#include "core/geometry/pose_near.h"
#include "odometry_fixtures.h"
#include "scan_image_slam/core/sensor/odometry_buffer.h"

#include <cmath>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

using Result = OdometryBuffer::Result;

/// A robot at (10, 5) that drives along y at 1 m/s: readings at 0 and 0.1 s.
OdometryBuffer Northwards() {
  OdometryBuffer buffer(Limits(10.0));
  buffer.Add(At(0.0), {10.0, 5.0, M_PI / 2.0});
  buffer.Add(At(0.1), {10.0, 5.1, M_PI / 2.0});
  return buffer;
}

/// What becomes of a step in 0.1 s from rest at the origin; the slack is 0.05 m and 0.05 rad.
Result ResultOfStep(const Pose2& step) {
  OdometryBuffer buffer(Limits(10.0));
  buffer.Add(At(0.0), {});
  buffer.Add(At(0.1), {});
  return buffer.Add(At(0.2), step);
}

TEST(OdometryReset, IsAStepFasterThanTheRobot) {
  EXPECT_EQ(ResultOfStep({0.349, 0.0, 0.0}), Result::kAdded);
  EXPECT_EQ(ResultOfStep({0.351, 0.0, 0.0}), Result::kReset);
  EXPECT_EQ(ResultOfStep({0.0, -0.351, 0.0}), Result::kReset);
}

TEST(OdometryReset, IsATurnFasterThanTheRobot) {
  EXPECT_EQ(ResultOfStep({0.0, 0.0, 0.749}), Result::kAdded);
  EXPECT_EQ(ResultOfStep({0.0, 0.0, 0.751}), Result::kReset);
  EXPECT_EQ(ResultOfStep({0.0, 0.0, -0.751}), Result::kReset);
}

TEST(OdometryReset, ATurnAcrossPiIsNone) {
  OdometryBuffer buffer(Limits(10.0));
  buffer.Add(At(0.0), {0.0, 0.0, 3.1});
  EXPECT_EQ(buffer.Add(At(0.1), {0.0, 0.0, -3.1}), Result::kAdded);
}

TEST(OdometryReset, ALongGapAllowsALongWay) {
  OdometryBuffer buffer = Northwards();
  EXPECT_EQ(buffer.Add(At(2.1), {10.0, 11.0, M_PI / 2.0}), Result::kAdded);
  ExpectPoseNear(*buffer.ContinuousPose(At(2.1)), {10.0, 11.0, M_PI / 2.0});
}

TEST(OdometryReset, TheContinuousPoseGoesOnAtTheSameVelocity) {
  OdometryBuffer buffer = Northwards();
  EXPECT_EQ(buffer.Add(At(0.3), {}), Result::kReset);
  ExpectPoseNear(*buffer.ContinuousPose(At(0.1)), {10.0, 5.1, M_PI / 2.0});
  ExpectPoseNear(*buffer.ContinuousPose(At(0.2)), {10.0, 5.2, M_PI / 2.0});
  ExpectPoseNear(*buffer.ContinuousPose(At(0.3)), {10.0, 5.3, M_PI / 2.0});
}

TEST(OdometryReset, LaterReadingsAreMotionsFromThere) {
  OdometryBuffer buffer = Northwards();
  buffer.Add(At(0.3), {});
  EXPECT_EQ(buffer.Add(At(0.4), {0.2, 0.0, 0.3}), Result::kAdded);  // forward, that is north
  ExpectPoseNear(*buffer.ContinuousPose(At(0.4)), {10.0, 5.5, M_PI / 2.0 + 0.3});
}

TEST(OdometryReset, OdomIsTheNewFrameAtAllTimes) {
  OdometryBuffer buffer = Northwards();
  buffer.Add(At(0.3), {});
  buffer.Add(At(0.4), {0.2, 0.0, 0.0});
  ExpectPoseNear(*buffer.OdomFromBase(At(0.4)), {0.2, 0.0, 0.0});
  ExpectPoseNear(*buffer.OdomFromBase(At(0.3)), {});
  ExpectPoseNear(*buffer.OdomFromBase(At(0.1)), {-0.2, 0.0, 0.0});  // on the way at 1 m/s
}

TEST(OdometryReset, ASecondResetStartsTheFrameAnew) {
  OdometryBuffer buffer = Northwards();
  buffer.Add(At(0.2), {});
  buffer.Add(At(0.3), {-4.0, 1.0, M_PI});
  ExpectPoseNear(*buffer.ContinuousPose(At(0.3)), {10.0, 5.3, M_PI / 2.0});
  ExpectPoseNear(*buffer.OdomFromBase(At(0.3)), {-4.0, 1.0, M_PI});
}

TEST(OdometryReset, AfterOneReadingNothingIsKnownOfTheVelocity) {
  OdometryBuffer buffer(Limits(10.0));
  buffer.Add(At(0.0), {10.0, 5.0, 1.0});
  EXPECT_EQ(buffer.Add(At(0.1), {}), Result::kReset);
  ExpectPoseNear(*buffer.ContinuousPose(At(0.1)), {10.0, 5.0, 1.0});
  ExpectPoseNear(*buffer.OdomFromBase(At(0.1)), {});
}

TEST(OdometryReset, TheVelocityIsKeptNoLongerThanItIsTrusted) {
  OdometryBuffer buffer = Northwards();
  EXPECT_EQ(buffer.Add(At(2.1), {}), Result::kReset);  // 11 m in 2 s
  ExpectPoseNear(*buffer.ContinuousPose(At(2.1)), {10.0, 5.1 + 0.25, M_PI / 2.0});
}

TEST(OdometryReset, JitteringStampsAreNone) {
  OdometryBuffer buffer(Limits(10.0));
  buffer.Add(At(0.0), {});
  for (int i = 1; i < 60; ++i) {  // 2 m/s at 30 Hz; every second reading comes 30 ms late
    const double late = i % 2 == 0 ? 0.0 : 0.030;
    EXPECT_EQ(buffer.Add(At(i / 30.0 + late), {2.0 * i / 30.0, 0.0, 0.0}), Result::kAdded) << i;
  }
}

TEST(OdometryReset, AGapDoesNotBluntTheEyeForTheNextOne) {
  OdometryBuffer buffer(Limits(10.0));
  for (int i = 0; i < 10; ++i) buffer.Add(At(0.1 * i), {});
  EXPECT_EQ(buffer.Add(At(100.0), {}), Result::kAdded);
  EXPECT_EQ(buffer.Add(At(100.1), {1.0, 0.0, 0.0}), Result::kReset);
}

TEST(OdometryReset, AfterClearTheFrameIsThatOfTheReadings) {
  OdometryBuffer buffer = Northwards();
  buffer.Add(At(0.2), {});
  buffer.Clear();
  buffer.Add(At(0.0), {1.0, 2.0, 0.5});
  ExpectPoseNear(*buffer.OdomFromBase(At(0.0)), {1.0, 2.0, 0.5});
  ExpectPoseNear(*buffer.ContinuousPose(At(0.0)), {1.0, 2.0, 0.5});
}

TEST(OdometryReset, AReadingFromTheFutureIsGotOver) {
  OdometryBuffer buffer = Northwards();
  buffer.Add(At(3600.0), {10.0, 5.2, M_PI / 2.0});
  for (int i = 0; i < 19; ++i) {
    const double t = 0.2 + 0.1 * i;
    EXPECT_EQ(buffer.Add(At(t), {10.0, 5.0 + t, M_PI / 2.0}), Result::kStale) << i;
  }
  const Pose2 before = *buffer.ContinuousPose(At(2.1));
  EXPECT_EQ(buffer.Add(At(2.1), {10.0, 7.1, M_PI / 2.0}), Result::kReset);
  buffer.Add(At(2.2), {10.0, 7.2, M_PI / 2.0});
  // What was driven in between is not known; from here on it is.
  const Pose2 after = *buffer.ContinuousPose(At(2.1));
  EXPECT_LT((after.translation() - before.translation()).norm(), 0.11);
  ExpectPoseNear(after.Inverse() * *buffer.ContinuousPose(At(2.2)), {0.1, 0.0, 0.0});
  ExpectPoseNear(*buffer.OdomFromBase(At(2.2)), {10.0, 7.2, M_PI / 2.0});
}

TEST(OdometryReset, ReadingsThatComeLateOrTwiceAreNone) {
  OdometryBuffer buffer = Northwards();
  for (int i = 0; i < 50; ++i) {
    EXPECT_EQ(buffer.Add(At(0.1), {10.0, 5.1, M_PI / 2.0}), Result::kStale);
    EXPECT_EQ(buffer.Add(At(0.05), {10.0, 5.05, M_PI / 2.0}), Result::kStale);
  }
  for (int i = 2; i < 40; ++i) {  // two that take turns, one of them late
    EXPECT_EQ(buffer.Add(At(0.1 * i), {10.0, 5.0 + 0.1 * i, M_PI / 2.0}), Result::kAdded);
    EXPECT_EQ(buffer.Add(At(0.1 * i - 0.05), {10.0, 5.0, M_PI / 2.0}), Result::kStale);
  }
}

TEST(OdometryReset, ClearForgetsTheUsualPeriod) {
  OdometryBuffer buffer(Limits(10.0));
  buffer.Add(At(0.0), {});
  buffer.Add(At(1.0), {});  // once a second
  buffer.Clear();
  buffer.Add(At(0.0), {});
  EXPECT_EQ(buffer.Add(At(0.05), {2.0, 0.0, 0.0}), Result::kReset);  // 40 m/s
}

}  // namespace
}  // namespace scan_image_slam
