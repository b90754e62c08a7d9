#include "scan_image_slam/core/matching/bounded_icp.h"
#include "support_rooms.h"

#include <cmath>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

constexpr double kPeriod = 0.025;  // [s]
constexpr double kGap = 3.0;       // [s]

/// A robot that drives through a furnished room, and whose nodes are stopped for a while.
class BlindMatchTest : public testing::Test {
 protected:
  /// On a circle of 1.5 m around the middle, 0.5 m/s.
  static Pose2 PoseAt(double seconds) {
    const double angle = seconds * 0.5 / 1.5;
    return Pose2{1.5 * std::cos(angle), 1.5 * std::sin(angle), angle + M_PI / 2.0};
  }

  void HearEncoders(double from, double to) {
    for (double t = from; t < to + 1e-6; t += 0.02) {
      bounded_icp_.AddOdometry(FromSeconds(1.0 + t), PoseAt(t));
    }
  }

  MatchedMotion MatchFrom(const Pose2& room_from_base, double seconds) {
    return bounded_icp_.Match(
        ModelOf(FurnishedRoom(), room_from_base, FromSeconds(1.0 + seconds), TestLaser()));
  }

  MatchedMotion Match(double seconds) { return MatchFrom(PoseAt(seconds), seconds); }

  /// Drives for two seconds with everything it needs.
  void Drive() {
    HearEncoders(0.0, kStop);
    for (double t = 0.0; t < kStop + 1e-6; t += kPeriod) Match(t);
  }

  static Pose2 PoseOf(const MatchedMotion& match) {
    return PoseAt(0.0) * match.start_from_reference * match.motion;
  }

  static double Error(const MatchedMotion& match, const Pose2& room_from_base) {
    return (PoseOf(match).translation() - room_from_base.translation()).norm();
  }

  static constexpr double kStop = 2.0;  // [s]
  BoundedIcp bounded_icp_{BoundedIcpOptions()};
};

TEST_F(BlindMatchTest, WaitsForTheEncodersIfMostOfTheScanIsNotFound) {
  Drive();
  double t = kStop + kGap;
  for (int i = 0; i < 5; ++i, t += kPeriod) {
    const MatchedMotion blind = Match(t);
    EXPECT_EQ(blind.status, MatchStatus::kTooFewPoints);
    EXPECT_EQ(blind.mode, MatchMode::kCoasting);
  }
  HearEncoders(kStop, t);
  const MatchedMotion seeing = Match(t);
  EXPECT_EQ(seeing.status, MatchStatus::kMatched);
  EXPECT_LT(Error(seeing, PoseAt(t)), 0.005);
}

TEST_F(BlindMatchTest, FindsItsWayThoughReadingsWereLostAroundTheLastScan) {
  HearEncoders(0.0, kStop - 0.4);
  for (double t = 0.0; t < kStop + 1e-6; t += kPeriod) Match(t);
  HearEncoders(kStop + kGap - 0.5, kStop + kGap);
  const MatchedMotion match = Match(kStop + kGap);
  EXPECT_EQ(match.status, MatchStatus::kMatched);
  EXPECT_LT(Error(match, PoseAt(kStop + kGap)), 0.005);
}

TEST_F(BlindMatchTest, GoesOnMeanwhileAsFarAsTheVelocityIsKept) {
  Drive();
  const MatchedMotion blind = Match(kStop + kGap);
  EXPECT_LT(Error(blind, PoseAt(kStop + 0.5)), 0.02);
  EXPECT_GT(blind.covariance(0, 0), 0.01 * 0.01);
}

TEST_F(BlindMatchTest, BelievesAScanOfWhichMostIsFound) {
  Drive();
  const MatchedMotion stood = MatchFrom(PoseAt(kStop), kStop + kGap);
  EXPECT_EQ(stood.status, MatchStatus::kMatched);
  EXPECT_LT(Error(stood, PoseAt(kStop)), 0.005);
}

TEST_F(BlindMatchTest, DoesNotWaitForEver) {
  Drive();
  int waited = 0;
  double t = kStop + kGap;
  while (waited < 100 && Match(t).matched < 600) {
    t += kPeriod;
    ++waited;
  }
  EXPECT_GT(waited, 10);
  EXPECT_LT(waited, 40);
}

TEST_F(BlindMatchTest, DoesNotWaitForEncodersThereNeverWere) {
  for (double t = 0.0; t < kStop + 1e-6; t += kPeriod) Match(t);
  const MatchedMotion match = Match(kStop + kGap);
  EXPECT_EQ(match.mode, MatchMode::kLaserOnly);
}

}  // namespace
}  // namespace scan_image_slam
