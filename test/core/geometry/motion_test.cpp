#include "core/geometry/pose_near.h"
#include "scan_image_slam/core/geometry/pose2.h"

#include <cmath>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

// A circle of radius 2 has quarters of length pi.
TEST(Arc, QuarterCircle) {
  ExpectPoseNear(Arc(M_PI, M_PI / 2.0), {2.0, 2.0, M_PI / 2.0}, 1e-15);
  ExpectPoseNear(Arc(M_PI, -M_PI / 2.0), {2.0, -2.0, -M_PI / 2.0}, 1e-15);
}

TEST(Arc, BackwardsTheRobotEndsBehind) {
  ExpectPoseNear(Arc(-M_PI, M_PI / 2.0), {-2.0, -2.0, M_PI / 2.0}, 1e-15);
}

TEST(Arc, StraightAndOnTheSpot) {
  ExpectPoseNear(Arc(1.5, 0.0), {1.5, 0.0, 0.0}, 1e-15);
  ExpectPoseNear(Arc(0.0, 1.2), {0.0, 0.0, 1.2}, 1e-15);
}

TEST(Arc, ALongTurnEndsWhereTheCircleCloses) {
  ExpectPoseNear(Arc(4.0 * M_PI, 2.0 * M_PI), {}, 1e-14);
  EXPECT_NEAR(Arc(1.0, 4.0).theta, 4.0 - 2.0 * M_PI, 1e-15);
}

TEST(Arc, TinyTurnsFollowTheSeries) {
  for (const double angle : {1e-9, 0.9e-6, 1.1e-6, 1e-5, 1e-3, -0.9e-6, -1.1e-6}) {
    const Pose2 pose = Arc(3.0, angle);
    EXPECT_NEAR(pose.x, 3.0 * (1.0 - angle * angle / 6.0), 1e-12) << angle;
    EXPECT_NEAR(pose.y, 3.0 * (angle / 2.0 - angle * angle * angle / 24.0), 1e-9) << angle;
  }
}

TEST(Arc, IsWhatADifferentialDriveDoes) {
  Dice dice;
  for (int i = 0; i < 20; ++i) {
    const double distance = dice.Between(-2.0, 2.0);
    const double angle = dice.Between(-3.0, 3.0);
    ExpectPoseNear(Arc(distance, angle), DriveInSmallSteps({distance, 0.0, angle}, 1.0), 1e-7);
  }
}

TEST(ArcCoordinates, TheOffsetIsToTheLeftAtTheEndOfTheArc) {
  ExpectPoseNear(FromArcCoordinates({M_PI, 1.0, M_PI / 2.0}), {1.0, 2.0, M_PI / 2.0}, 1e-15);
}

TEST(ArcCoordinates, SplitAMotionByHand) {
  const ArcCoordinates arc = ToArcCoordinates({1.0, 2.0, M_PI / 2.0});
  EXPECT_NEAR(arc.distance, M_PI, 1e-14);
  EXPECT_NEAR(arc.lateral, 1.0, 1e-14);
  EXPECT_NEAR(arc.angle, M_PI / 2.0, 1e-15);
}

TEST(ArcCoordinates, WithoutATurnTheyAreThePosition) {
  const ArcCoordinates arc = ToArcCoordinates({1.0, -0.25, 0.0});
  EXPECT_DOUBLE_EQ(arc.distance, 1.0);
  EXPECT_DOUBLE_EQ(arc.lateral, -0.25);
}

TEST(ArcCoordinates, ComeBackFromAMotion) {
  Dice dice;
  for (int i = 0; i < 1000; ++i) {
    const ArcCoordinates arc{dice.Between(-3, 3), dice.Between(-1, 1), dice.Between(-3.1, 3.1)};
    const ArcCoordinates back = ToArcCoordinates(FromArcCoordinates(arc));
    EXPECT_NEAR(back.distance, arc.distance, 1e-11) << arc.angle;
    EXPECT_NEAR(back.lateral, arc.lateral, 1e-11) << arc.angle;
    EXPECT_NEAR(back.angle, arc.angle, 1e-12);
  }
}

TEST(ArcCoordinates, MakeUpEveryMotion) {
  Dice dice;
  for (int i = 0; i < 1000; ++i) {
    const Pose2 motion{dice.Between(-3, 3), dice.Between(-3, 3), dice.Between(-3.1, 3.1)};
    ExpectPoseNear(FromArcCoordinates(ToArcCoordinates(motion)), motion, 1e-11);
  }
}

TEST(Velocity2, Adds) {
  const Velocity2 sum = Velocity2{1.0, 2.0, 3.0} + Velocity2{0.5, -3.0, 0.25};
  EXPECT_DOUBLE_EQ(sum.x, 1.5);
  EXPECT_DOUBLE_EQ(sum.y, -1.0);
  EXPECT_DOUBLE_EQ(sum.theta, 3.25);
}

TEST(Move, ForwardAndSidewaysOnAQuarterCircle) {
  const double side = 2.0 / M_PI;  // radius of a quarter circle of length 1
  ExpectPoseNear(Move({0.5, 0.0, M_PI / 4.0}, 2.0), {side, side, M_PI / 2.0}, 1e-15);
  ExpectPoseNear(Move({0.0, 0.5, M_PI / 4.0}, 2.0), {-side, side, M_PI / 2.0}, 1e-15);
}

TEST(Move, WithoutATurnIsSpeedTimesTime) {
  ExpectPoseNear(Move({0.5, -0.25, 0.0}, 4.0), {2.0, -1.0, 0.0}, 1e-15);
}

TEST(Move, IsWhatSmallStepsAddUpTo) {
  Dice dice;
  for (int i = 0; i < 20; ++i) {
    const Velocity2 v{dice.Between(-1, 1), dice.Between(-1, 1), dice.Between(-1.5, 1.5)};
    ExpectPoseNear(Move(v, 2.0), DriveInSmallSteps(v, 2.0), 1e-7);
  }
}

TEST(Move, BackInTimeIsTheInverse) {
  const Velocity2 v{0.7, -0.2, 0.9};
  ExpectPoseNear(Move(v, -1.5), Move(v, 1.5).Inverse(), 1e-14);
}

TEST(VelocityOf, IsTheInverseOfMove) {
  Dice dice;
  for (int i = 0; i < 1000; ++i) {
    const double dt = dice.Between(0.02, 2.0) * (i % 2 == 0 ? 1.0 : -1.0);
    const Velocity2 v{dice.Between(-2, 2), dice.Between(-2, 2), dice.Between(-1.5, 1.5)};
    const Velocity2 back = VelocityOf(Move(v, dt), dt);
    EXPECT_NEAR(back.x, v.x, 1e-11);
    EXPECT_NEAR(back.y, v.y, 1e-11);
    EXPECT_NEAR(back.theta, v.theta, 1e-11);
  }
}

TEST(VelocityOf, MoveGivesTheMotionBack) {
  Dice dice;
  for (int i = 0; i < 1000; ++i) {
    const Pose2 motion = dice.Pose();
    ExpectPoseNear(Move(VelocityOf(motion, 0.3), 0.3), motion, 1e-11);
  }
}

}  // namespace
}  // namespace scan_image_slam
