#include "core/geometry/pose_near.h"
#include "scan_image_slam/core/fusion/scan_model.h"
#include "support_fusion.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

Eigen::Isometry3d Mounted(const Eigen::Vector3d& at, double yaw, double pitch, double roll) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = (Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                   Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
                   Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()))
                      .toRotationMatrix();
  pose.translation() = at;
  return pose;
}

LaserScan ThreeBeams(double angle_min, double increment) {
  LaserScan scan;
  scan.angle_min = angle_min;
  scan.angle_increment = increment;
  scan.range_min = 0.1;
  scan.range_max = 30.0;
  scan.ranges = {1.0f, 2.0f, 3.0f};
  return scan;
}

/// The last of three beams, at bearing 0 and range 3 m, fired `delay` after the stamp.
Eigen::Vector2d PointOfLateBeam(double delay, const Velocity2& velocity, const LaserMount& mount) {
  LaserScan scan = ThreeBeams(-2.0 * kDegree, kDegree);
  scan.time_increment = 0.5 * delay;
  return MakeScanModel(scan, mount, velocity, {}).beams[2].point;
}

void ExpectPoint(const Eigen::Vector2d& actual, double x, double y, double tolerance = 1e-12) {
  EXPECT_NEAR(actual.x(), x, tolerance);
  EXPECT_NEAR(actual.y(), y, tolerance);
}

TEST(LaserMount, TakesThePlaceFromTheTransform) {
  const LaserMount mount = LaserMount::From(Mounted({0.2, -0.1, 0.35}, 0.5, 0.0, 0.0));
  ExpectPoseNear(mount.base_from_laser, {0.2, -0.1, 0.5}, 1e-15);
  EXPECT_DOUBLE_EQ(mount.height, 0.35);
  EXPECT_FALSE(mount.upside_down);
}

TEST(LaserMount, ALaserOnItsHeadIsUpsideDown) {
  EXPECT_TRUE(LaserMount::From(Mounted({0, 0, 0}, 0.0, 0.0, M_PI)).upside_down);
  EXPECT_TRUE(LaserMount::From(Mounted({0, 0, 0}, 0.0, M_PI, 0.0)).upside_down);
}

TEST(LaserMount, ATiltedLaserIsRefused) {
  for (const double level : {0.0, M_PI}) {
    EXPECT_NO_THROW(LaserMount::From(Mounted({0, 0, 0}, 1.0, 0.0, level + 1.9 * kDegree)));
    EXPECT_THROW(LaserMount::From(Mounted({0, 0, 0}, 1.0, 0.0, level + 2.1 * kDegree)),
                 std::invalid_argument);
    EXPECT_THROW(LaserMount::From(Mounted({0, 0, 0}, 1.0, -2.1 * kDegree, level)),
                 std::invalid_argument);
  }
  EXPECT_THROW(LaserMount::From(Mounted({0, 0, 0}, 0.0, 90.0 * kDegree, 0.0)),
               std::invalid_argument);
}

TEST(MakeScanModel, PointsAreWhereTheTransformPutsThem) {
  const LaserScan scan = ThreeBeams(0.4, 0.3);
  Dice dice;
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d at(dice.Between(-1, 1), dice.Between(-1, 1), 0.3);
    const double roll = i % 2 == 0 ? 0.0 : M_PI;
    const Eigen::Isometry3d mounted = Mounted(at, dice.Between(-M_PI, M_PI), 0.0, roll);
    const FusedModel model = MakeScanModel(scan, LaserMount::From(mounted), {}, {});
    for (int k = 0; k < 3; ++k) {
      const double bearing = 0.4 + 0.3 * k;
      const Eigen::Vector3d p =
          mounted * ((k + 1.0) * Eigen::Vector3d(std::cos(bearing), std::sin(bearing), 0.0));
      ExpectPoint(model.beams[k].point, p.x(), p.y());
    }
  }
}

TEST(MakeScanModel, AYawedLaserAtAnOffsetByHand) {
  LaserMount mount;
  mount.base_from_laser = {0.2, 0.1, M_PI / 2.0};
  ExpectPoint(PointOfLateBeam(0.0, {}, mount), 0.2, 3.1);
}

TEST(MakeScanModel, UpsideDownLeftIsRight) {
  LaserMount mount;
  mount.upside_down = true;
  const FusedModel model = MakeScanModel(ThreeBeams(0.0, M_PI / 4.0), mount, {}, {});
  EXPECT_TRUE(model.upside_down);
  ExpectPoint(model.beams[2].point, 0.0, -3.0);
}

TEST(MakeScanModel, AClockwiseSweepStaysInItsOrder) {
  const FusedModel model = MakeScanModel(ThreeBeams(M_PI / 2.0, -M_PI / 2.0), {}, {}, {});
  ASSERT_EQ(model.beams.size(), 3U);
  ExpectPoint(model.beams[0].point, 0.0, 1.0);
  ExpectPoint(model.beams[1].point, 2.0, 0.0);
  ExpectPoint(model.beams[2].point, 0.0, -3.0);
}

TEST(MakeScanModel, ACutDoesNotChangeWhenABeamWasFired) {
  LaserScan scan = ThreeBeams(-M_PI / 2.0, M_PI / 2.0);
  scan.time_increment = 0.001;
  ScanModelOptions options;
  options.field_of_view = M_PI / 2.0;
  const FusedModel model = MakeScanModel(scan, {}, {}, options);
  ASSERT_EQ(model.beams.size(), 1U);
  EXPECT_DOUBLE_EQ(model.beams[0].time_offset, 0.001);
}

TEST(MakeScanModel, SaysWhatItWasMadeOf) {
  LaserScan scan = ThreeBeams(0.0, 0.1);
  scan.stamp = 1234567;
  LaserMount mount;
  mount.base_from_laser = {0.2, 0.1, 0.3};
  const FusedModel model = MakeScanModel(scan, mount, {0.5, 0.25, 0.125}, {});
  EXPECT_EQ(model.stamp, 1234567);
  ExpectPoseNear(model.base_from_laser, {0.2, 0.1, 0.3}, 0.0);
  EXPECT_EQ(model.sweep_velocity.x, 0.5);
  EXPECT_EQ(model.sweep_velocity.y, 0.25);
  EXPECT_EQ(model.sweep_velocity.theta, 0.125);
  EXPECT_FALSE(model.has_image);
  EXPECT_TRUE(model.edges.empty());
}

TEST(SweepCorrection, WhatADrivingBaseSeesLaterIsFartherAway) {
  ExpectPoint(PointOfLateBeam(0.02, {1.5, 0.0, 0.0}, {}), 3.03, 0.0);
}

TEST(SweepCorrection, ATurningBaseHasTurnedTowardsWhatItSeesLater) {
  const double r = 3.0 * std::sqrt(0.5);
  ExpectPoint(PointOfLateBeam(0.5, {0.0, 0.0, M_PI / 2.0}, {}), r, r);
}

TEST(SweepCorrection, ATurningBaseSwingsAnOffsetLaser) {
  LaserMount mount;
  mount.base_from_laser = {0.5, 0.0, 0.0};
  ExpectPoint(PointOfLateBeam(1.0, {0.0, 0.0, M_PI / 2.0}, mount), 0.0, 3.5);
}

TEST(SweepCorrection, ABaseThatDrivesAQuarterCircle) {
  // From (0, 0) to (1, 1), where it looks along y.
  ExpectPoint(PointOfLateBeam(1.0, {M_PI / 2.0, 0.0, M_PI / 2.0}, {}), 1.0, 4.0);
}

TEST(SweepCorrection, MakesAWallStraightForABaseThatDrivesACurve) {
  PaintedWorld world;
  world.AddWall({3, -50}, {3, 50});
  constexpr double kSpeed = 1.0;
  constexpr double kTurnRate = 2.0;
  LaserScan scan = world.Scan({}, -1.0, 0.01, 201);
  scan.time_increment = 1e-4;
  for (int i = 0; i < 201; ++i) {
    const double t = 1e-4 * i;
    const double heading = kTurnRate * t;
    const Pose2 base{kSpeed / kTurnRate * std::sin(heading),
                     kSpeed / kTurnRate * (1.0 - std::cos(heading)), heading};
    scan.ranges[i] = static_cast<float>(world.Range({base.x, base.y}, heading - 1.0 + 0.01 * i));
  }
  const FusedModel model = MakeScanModel(scan, {}, {kSpeed, 0.0, kTurnRate}, {});
  for (const ModelBeam& beam : model.beams) EXPECT_NEAR(beam.point.x(), 3.0, 1e-5);
}

}  // namespace
}  // namespace scan_image_slam
