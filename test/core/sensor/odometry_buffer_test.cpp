#include "scan_image_slam/core/sensor/odometry_buffer.h"

#include "core/geometry/pose_near.h"
#include "odometry_fixtures.h"
#include "support_options.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

using Result = OdometryBuffer::Result;

/// Readings every 0.1 s of a robot that drives along x at 1 m/s from x = 0.
OdometryBuffer Straight(int readings) {
  OdometryBuffer buffer(Limits(1.0));
  for (int i = 0; i < readings; ++i) {
    EXPECT_EQ(buffer.Add(At(0.1 * i), {0.1 * i, 0.0, 0.0}), Result::kAdded);
  }
  return buffer;
}

void ExpectPoseAt(const OdometryBuffer& buffer, double seconds, const Pose2& expected) {
  const std::optional<Pose2> pose = buffer.ContinuousPose(At(seconds));
  ASSERT_TRUE(pose) << seconds;
  ExpectPoseNear(*pose, expected, 1e-9);
}

TEST(OdometryOptions, NamesTheFieldThatIsWrong) {
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double value : {0.0, -1.0, infinity, std::nan("")}) {
    ExpectRefused(&OdometryOptions::max_speed, value, "max_speed");
    ExpectRefused(&OdometryOptions::max_turn_rate, value, "max_turn_rate");
    ExpectRefused(&OdometryOptions::max_extrapolation, value, "max_extrapolation");
    ExpectRefused(&OdometryOptions::history, value, "history");
  }
}

TEST(OdometryBuffer, RefusesWrongOptions) {
  OdometryOptions options;
  options.history = 0.0;
  EXPECT_THROW(OdometryBuffer{options}, std::invalid_argument);
}

TEST(OdometryBuffer, WithoutReadingsThereIsNoPose) {
  const OdometryBuffer buffer(Limits(1.0));
  EXPECT_TRUE(buffer.empty());
  EXPECT_FALSE(buffer.ContinuousPose(At(0.0)));
  EXPECT_FALSE(buffer.OdomFromBase(At(0.0)));
}

TEST(OdometryBuffer, GivesTheReadingsBack) {
  const OdometryBuffer buffer = Straight(4);
  EXPECT_FALSE(buffer.empty());
  EXPECT_EQ(buffer.newest_stamp(), At(0.3));
  for (const double t : {0.0, 0.1, 0.2, 0.3}) ExpectPoseAt(buffer, t, {t, 0.0, 0.0});
}

TEST(OdometryBuffer, InterpolatesAlongTheCircle) {
  OdometryBuffer buffer(Limits(1.0));
  // A quarter of a circle of radius 0.1 around (0, 0.1), slow enough not to be a reset.
  buffer.Add(At(0.0), {0.0, 0.0, 0.0});
  buffer.Add(At(0.6), {0.1, 0.1, M_PI / 2.0});
  const double c = std::cos(M_PI / 6.0);  // a third of the way is 30 degrees
  ExpectPoseAt(buffer, 0.2, {0.1 * 0.5, 0.1 - 0.1 * c, M_PI / 6.0});
}

TEST(OdometryBuffer, InterpolatesBetweenTheRightReadings) {
  OdometryBuffer buffer(Limits(1.0));
  buffer.Add(At(0.0), {0.0, 0.0, 0.0});
  buffer.Add(At(0.1), {0.1, 0.0, 0.0});
  buffer.Add(At(0.3), {0.1, 0.0, 0.4});
  ExpectPoseAt(buffer, 0.05, {0.05, 0.0, 0.0});
  ExpectPoseAt(buffer, 0.25, {0.1, 0.0, 0.3});
}

TEST(OdometryBuffer, SurroundsWhatLiesBetweenReadingsWithoutAPause) {
  OdometryBuffer buffer{OdometryOptions()};
  EXPECT_FALSE(buffer.Surrounds(At(1.0)));
  for (const double at : {1.0, 1.2, 2.0}) buffer.Add(At(at), {at, 0.0, 0.0});
  EXPECT_FALSE(buffer.Surrounds(At(0.9)));
  EXPECT_TRUE(buffer.Surrounds(At(1.0)));
  EXPECT_TRUE(buffer.Surrounds(At(1.1)));
  EXPECT_FALSE(buffer.Surrounds(At(1.3)));
  EXPECT_FALSE(buffer.Surrounds(At(2.1)));
}

TEST(OdometryBuffer, GoesOnAtTheLastVelocityBehindTheNewest) {
  OdometryBuffer buffer = Straight(2);
  buffer.Add(At(0.2), {0.3, 0.0, 0.0});  // now 2 m/s
  ExpectPoseAt(buffer, 0.3, {0.5, 0.0, 0.0});
  ExpectPoseAt(buffer, 0.45, {0.8, 0.0, 0.0});
}

TEST(OdometryBuffer, ExtrapolatesOnlySoFarBehindTheNewest) {
  const OdometryBuffer buffer = Straight(2);
  EXPECT_TRUE(buffer.ContinuousPose(At(0.1 + 0.25)));
  EXPECT_FALSE(buffer.ContinuousPose(At(0.1 + 0.251)));
  EXPECT_FALSE(buffer.OdomFromBase(At(0.1 + 0.251)));
}

TEST(OdometryBuffer, StandsStillBeforeTheFirst) {
  OdometryBuffer buffer(Limits(1.0));
  buffer.Add(At(0.0), {1.0, 2.0, 0.5});
  buffer.Add(At(0.1), {1.1, 2.0, 0.5});
  ExpectPoseAt(buffer, -0.25, {1.0, 2.0, 0.5});
  EXPECT_FALSE(buffer.ContinuousPose(At(-0.251)));
}

TEST(OdometryBuffer, AStaleReadingChangesNothing) {
  OdometryBuffer buffer = Straight(3);
  EXPECT_EQ(buffer.Add(At(0.2), {0.25, 0.1, 0.1}), Result::kStale);
  EXPECT_EQ(buffer.Add(At(0.15), {0.25, 0.1, 0.1}), Result::kStale);
  EXPECT_EQ(buffer.newest_stamp(), At(0.2));
  ExpectPoseAt(buffer, 0.2, {0.2, 0.0, 0.0});
  EXPECT_EQ(buffer.Add(At(0.3), {0.3, 0.0, 0.0}), Result::kAdded);
  ExpectPoseAt(buffer, 0.3, {0.3, 0.0, 0.0});
}

TEST(OdometryBuffer, WithoutAResetOdomIsTheContinuousFrame) {
  const OdometryBuffer buffer = Straight(3);
  for (const double t : {-0.1, 0.05, 0.2, 0.3}) {
    ExpectPoseNear(*buffer.OdomFromBase(At(t)), *buffer.ContinuousPose(At(t)), 1e-12);
  }
}

TEST(OdometryBuffer, KeepsAsMuchHistoryAsItIsTold) {
  const OdometryBuffer buffer = Straight(31);  // to 3 s, with a history of 1 s
  ExpectPoseAt(buffer, 2.05, {2.05, 0.0, 0.0});
  EXPECT_FALSE(buffer.ContinuousPose(At(3.0 - 1.0 - 0.1 - 0.26)));
}

TEST(OdometryBuffer, KeepsTwoReadingsHoweverOld) {
  OdometryOptions options = Limits(1.0);
  options.history = 0.01;
  OdometryBuffer buffer(options);
  for (int i = 0; i < 5; ++i) buffer.Add(At(0.1 * i), {0.1 * i, 0.0, 0.0});
  ExpectPoseAt(buffer, 0.35, {0.35, 0.0, 0.0});
  ExpectPoseAt(buffer, 0.5, {0.5, 0.0, 0.0});
}

TEST(OdometryBuffer, ClearForgetsTheReadingsAndTheirTime) {
  OdometryBuffer buffer = Straight(3);
  buffer.Clear();
  EXPECT_TRUE(buffer.empty());
  EXPECT_FALSE(buffer.ContinuousPose(At(0.1)));
  EXPECT_EQ(buffer.Add(At(-500.0), {70.0, 0.0, 0.0}), Result::kAdded);
  ExpectPoseAt(buffer, -500.0, {70.0, 0.0, 0.0});
}

TEST(OdometryBuffer, TwoReadingsAtOnceAfterAPauseDoNotMakeTheRobotFlyOff) {
  OdometryBuffer buffer(Limits(1.0));
  for (int i = 0; i < 30; ++i) buffer.Add(At(i / 30.0), {0.02 * i, 0.0, 0.0});  // 0.6 m/s
  buffer.Add(At(3.0), {1.8, 0.0, 0.0});
  buffer.Add(At(3.001), {1.82, 0.0, 0.0});
  const std::optional<Pose2> ahead = buffer.ContinuousPose(At(3.021));
  ASSERT_TRUE(ahead);
  EXPECT_LT(ahead->x, 1.82 + Limits(1.0).max_speed * 0.02);
}

TEST(OdometryBuffer, TheVelocityIsNotThatOfBeforeAPause) {
  OdometryBuffer buffer(Limits(1.0));
  for (int i = 0; i < 10; ++i) buffer.Add(At(0.02 * i), {0.0, 0.0, 0.0});
  for (int i = 0; i < 4; ++i) buffer.Add(At(3.0 + 0.02 * i), {0.01 * i, 0.0, 0.0});  // 0.5 m/s
  ExpectPoseAt(buffer, 3.16, {0.08, 0.0, 0.0});
}

// Encoders that count whole millimetres, at 25 mm/s: a step of one or none each 20 ms.
TEST(OdometryBuffer, TheResolutionOfTheEncodersIsNotTakenForVelocity) {
  OdometryBuffer buffer{OdometryOptions()};
  constexpr Stamp kMs = 1000000;
  for (int i = 0; i <= 8; ++i) buffer.Add(i * 20 * kMs, {0.001 * (i / 2), 0.0, 0.0});
  // Over the last 100 ms 3 mm, in the last 20 ms 1 mm.
  EXPECT_NEAR(buffer.ContinuousPose(180 * kMs)->x, 0.004 + 0.2 * 0.003, 1e-12);
}

}  // namespace
}  // namespace scan_image_slam
