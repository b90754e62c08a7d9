#include "scan_image_slam/core/recording/odometry_record.h"

#include "core/recording/findings.h"

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

constexpr Stamp kStart = 1'000'000'000'000;

/// A robot at 0.5 m/s along x, at 20 Hz for `seconds`, set back to zero at `reset` [s].
OdometryRecord Drive(double seconds, double reset = 1e9) {
  OdometryRecord record;
  for (int i = 0; i * 0.05 < seconds; ++i) {
    const double t = i * 0.05;
    record.Add(kStart + FromSeconds(t), Pose2{t < reset ? 0.5 * t : 0.5 * (t - reset), 0.0, 0.0});
  }
  return record;
}

TEST(OdometryRecord, WayAndAngle) {
  OdometryRecord record;
  record.Add(kStart, Pose2{0.0, 0.0, 0.0});
  record.Add(kStart + FromSeconds(1.0), Pose2{0.3, 0.4, 0.2});
  record.Add(kStart + FromSeconds(2.0), Pose2{0.3, 0.4, -0.1});
  EXPECT_NEAR(record.way(), 0.5, 1e-9);
  EXPECT_NEAR(record.turned(), 0.5, 1e-9);
  EXPECT_EQ(record.resets(), 0);
  EXPECT_TRUE(CheckOdometry("/odom", record, kStart).empty());
}

TEST(OdometryRecord, AReadingThatDoesNotAdvanceIsNoMotion) {
  OdometryRecord record = Drive(2.0);
  const double way = record.way();
  record.Add(kStart + FromSeconds(1.0), Pose2{0.0, 0.0, 0.0});
  EXPECT_EQ(record.way(), way);
}

TEST(OdometryRecord, AResetIsNoWay) {
  const OdometryRecord record = Drive(20.0, 12.0);
  EXPECT_EQ(record.resets(), 1);
  EXPECT_NEAR(Seconds(record.first_reset() - kStart), 12.0, 1e-6);
  EXPECT_NEAR(record.way(), 10.0, 0.06);
  const Finding finding = FindingWith(CheckOdometry("/odom", record, kStart), "jump once");
  EXPECT_NE(finding.text.find("12 s after"), std::string::npos) << finding.text;
}

TEST(OdometryRecord, EncodersThatNeverMove) {
  OdometryRecord record;
  for (int i = 0; i < 100; ++i) record.Add(kStart + FromSeconds(0.05 * i), Pose2{1.0, 2.0, 0.3});
  EXPECT_EQ(FindingWith(CheckOdometry("/odom", record, kStart), "never move").severity,
            Severity::kWarning);
}

}  // namespace
}  // namespace scan_image_slam
