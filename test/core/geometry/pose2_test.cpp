#include "scan_image_slam/core/geometry/pose2.h"

#include "core/geometry/pose_near.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

TEST(NormalizeAngle, KeepsWhatIsInTheInterval) {
  for (const double angle : {0.0, 1.5, -1.5, 3.1415, -3.1415, M_PI}) {
    EXPECT_EQ(NormalizeAngle(angle), angle);
  }
}

TEST(NormalizeAngle, TheIntervalIsOpenAtMinusPi) { EXPECT_EQ(NormalizeAngle(-M_PI), M_PI); }

TEST(NormalizeAngle, TakesOffWholeTurns) {
  EXPECT_NEAR(NormalizeAngle(4.0), 4.0 - 2.0 * M_PI, 1e-15);
  EXPECT_NEAR(NormalizeAngle(-4.0), 2.0 * M_PI - 4.0, 1e-15);
  EXPECT_NEAR(NormalizeAngle(2.0 * M_PI + 0.25), 0.25, 1e-14);
  EXPECT_NEAR(NormalizeAngle(-2000.0 * M_PI - 0.25), -0.25, 1e-11);
}

TEST(NormalizeAngle, IsTheSameDirectionInTheInterval) {
  Dice dice;
  for (int i = 0; i < 1000; ++i) {
    const double angle = dice.Between(-1000.0, 1000.0);
    const double normal = NormalizeAngle(angle);
    EXPECT_GT(normal, -M_PI);
    EXPECT_LE(normal, M_PI);
    EXPECT_NEAR(AngleBetween(angle, normal), 0.0, 1e-12) << angle;
  }
}

TEST(NormalizeAngle, DoesNotMakeAnAngleOfNonsense) {
  EXPECT_TRUE(std::isnan(NormalizeAngle(std::nan(""))));
  EXPECT_TRUE(std::isnan(NormalizeAngle(std::numeric_limits<double>::infinity())));
}

TEST(Pose2, MovesAPoint) {
  const Eigen::Vector2d moved = Pose2{1.0, 2.0, M_PI / 2.0} * Eigen::Vector2d(3.0, 4.0);
  EXPECT_NEAR(moved.x(), 1.0 - 4.0, 1e-15);
  EXPECT_NEAR(moved.y(), 2.0 + 3.0, 1e-15);
}

TEST(Pose2, ChainsByHand) {
  const Pose2 chained = Pose2{1.0, 2.0, M_PI / 2.0} * Pose2{3.0, 4.0, M_PI / 2.0};
  ExpectPoseNear(chained, {-3.0, 5.0, M_PI}, 1e-14);
}

TEST(Pose2, TheAngleOfAChainIsNormal) {
  EXPECT_NEAR((Pose2{0, 0, 3.0} * Pose2{0, 0, 3.0}).theta, 6.0 - 2.0 * M_PI, 1e-14);
  EXPECT_NEAR((Pose2{0, 0, -3.0} * Pose2{0, 0, -3.0}).theta, 2.0 * M_PI - 6.0, 1e-14);
}

TEST(Pose2, InvertsByHand) {
  ExpectPoseNear(Pose2{1.0, 2.0, M_PI / 2.0}.Inverse(), {-2.0, 1.0, -M_PI / 2.0}, 1e-15);
}

TEST(Pose2, TheInverseOfAHalfTurnIsInTheInterval) {
  EXPECT_EQ((Pose2{0.0, 0.0, M_PI}.Inverse().theta), M_PI);
}

TEST(Pose2, AMotionAndItsInverseCancel) {
  Dice dice;
  for (int i = 0; i < 100; ++i) {
    const Pose2 a = dice.Pose();
    ExpectPoseNear(a * a.Inverse(), {}, 1e-13);
    ExpectPoseNear(a.Inverse() * a, {}, 1e-13);
  }
}

TEST(Pose2, TheInverseOfAChainIsTheChainOfInversesBackwards) {
  Dice dice;
  for (int i = 0; i < 100; ++i) {
    const Pose2 a = dice.Pose();
    const Pose2 b = dice.Pose();
    ExpectPoseNear((a * b).Inverse(), b.Inverse() * a.Inverse(), 1e-13);
  }
}

TEST(Pose2, AChainMovesPointsAsItsPartsDo) {
  Dice dice;
  for (int i = 0; i < 100; ++i) {
    const Pose2 a = dice.Pose();
    const Pose2 b = dice.Pose();
    const Eigen::Vector2d p(dice.Between(-5, 5), dice.Between(-5, 5));
    EXPECT_NEAR((a * b * p - a * (b * p)).norm(), 0.0, 1e-13);
  }
}

TEST(RigidTransform2, MovesAPoint) {
  const RigidTransform2 transform({1.0, 2.0, M_PI / 2.0});
  EXPECT_NEAR((transform * Eigen::Vector2d(3.0, 4.0) - Eigen::Vector2d(-3.0, 5.0)).norm(), 0,
              1e-15);
}

TEST(RigidTransform2, RotatesADirectionWithoutMovingIt) {
  const RigidTransform2 transform({1.0, 2.0, M_PI / 2.0});
  const Eigen::Vector2d rotated = transform.Rotate({3.0, 4.0});
  EXPECT_NEAR((rotated - Eigen::Vector2d(-4.0, 3.0)).norm(), 0.0, 1e-15);
}

TEST(Interpolate, KeepsTheEnds) {
  Dice dice;
  for (int i = 0; i < 100; ++i) {
    const Pose2 a = dice.Pose();
    const Pose2 b = dice.Pose();
    ExpectPoseNear(Interpolate(a, b, 0.0), a, 1e-12);
    ExpectPoseNear(Interpolate(a, b, 1.0), b, 1e-12);
  }
}

// A quarter of the unit circle around (5, 6), counter-clockwise from its right.
const Pose2 kRight{6.0, 6.0, M_PI / 2.0};
const Pose2 kTop{5.0, 7.0, M_PI};

TEST(Interpolate, HalfWayIsOnTheCircle) {
  const double r = std::sqrt(0.5);
  ExpectPoseNear(Interpolate(kRight, kTop, 0.5), {5.0 + r, 6.0 + r, 0.75 * M_PI}, 1e-14);
}

TEST(Interpolate, ExtrapolatesAlongTheCircle) {
  ExpectPoseNear(Interpolate(kRight, kTop, 2.0), {4.0, 6.0, -M_PI / 2.0}, 1e-14);
  ExpectPoseNear(Interpolate(kRight, kTop, -1.0), {5.0, 5.0, 0.0}, 1e-14);
}

TEST(Interpolate, TurnsTheShortWayAcrossPi) {
  const Pose2 half = Interpolate({0.0, 0.0, 3.0}, {0.0, 0.0, -3.1}, 0.5);
  EXPECT_NEAR(half.theta, 3.0 + 0.5 * (2.0 * M_PI - 6.1), 1e-14);
}

}  // namespace
}  // namespace scan_image_slam
