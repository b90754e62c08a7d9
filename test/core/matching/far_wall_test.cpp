// A corridor whose end comes into view: few beams meet it, and it is all that tells of the way.
#include "scan_image_slam/core/matching/bounded_icp.h"
#include "support_rooms.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

constexpr double kEnd = 36.0;    // [m]
constexpr double kReach = 30.0;  // of the laser [m]
constexpr double kScale = 1.02;  // what the encoders say by what was driven
constexpr double kStep = 0.025;  // [m]

/// Drives along the corridor from x = 0 by laser and encoders alone.
class FarWall : public testing::Test {
 protected:
  void DriveTo(double x) {
    while (x_ < x) {
      matcher_.AddOdometry(stamp_, {told_, 0.0, 0.0});
      TestLaser laser;
      laser.max_range = kReach;
      laser.range_stddev = 0.01;
      const Room room = PlainCorridor() + Room{{{kEnd, -1.0}, {kEnd, 1.0}}};
      match_ = matcher_.Match(ModelOf(room, {x_, 0.0, 0.0}, stamp_, laser, &random_));
      x_ += kStep;
      told_ += kScale * kStep;
      stamp_ += FromSeconds(0.025);
    }
  }
  /// How far the last pose lies too far along the corridor.
  double Error() const { return match_.start_from_base().x - (x_ - kStep); }

  TestRandom random_{11};
  BoundedIcp matcher_{BoundedIcpOptions()};
  MatchedMotion match_;
  double x_ = 0.0;
  double told_ = 0.0;
  Stamp stamp_ = FromSeconds(100.0);
};

TEST_F(FarWall, TheEncodersTellTheWayBeforeItComesIntoView) {
  DriveTo(kEnd - kReach - 0.2);
  EXPECT_EQ(match_.status, MatchStatus::kDegenerate);
  EXPECT_NEAR(Error(), (kScale - 1.0) * x_, 0.01);
}

TEST_F(FarWall, OnceInViewTheErrorGrowsNoMore) {
  DriveTo(kEnd - kReach + 0.3);
  EXPECT_EQ(match_.status, MatchStatus::kMatched);
  const double error = Error();
  DriveTo(kEnd - kReach + 8.0);
  EXPECT_EQ(match_.status, MatchStatus::kMatched);
  EXPECT_NEAR(Error(), error, 0.015);  // of 0.16 m
}

TEST_F(FarWall, WhatWasNotKnownBeforeIsNotKnownAfter) {
  DriveTo(kEnd - kReach - 0.2);
  const double before = match_.covariance(0, 0);
  DriveTo(kEnd - kReach + 8.0);
  EXPECT_GE(match_.covariance(0, 0), before);
  EXPECT_LT(match_.covariance(0, 0), 1.3 * before);
}

TEST_F(FarWall, WheelsThatSlipAreFoundOut) {
  DriveTo(kEnd - kReach + 4.0);
  const double error = Error();
  told_ += 0.04;
  DriveTo(kEnd - kReach + 7.0);
  EXPECT_NEAR(Error(), error, 0.02);
}

}  // namespace
}  // namespace scan_image_slam
