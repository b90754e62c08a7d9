#include "scan_image_slam/core/recording/scan_record.h"

#include "core/recording/findings.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

/// 271 beams over 270 degrees in 18 ms, as from a good driver.
LaserScan GoodScan() {
  LaserScan scan;
  scan.angle_min = -0.75 * M_PI;
  scan.angle_increment = M_PI / 180.0;
  scan.time_increment = 0.018 / 270.0;
  scan.range_min = 0.1;
  scan.range_max = 30.0;
  scan.ranges.assign(271, 2.0f);
  return scan;
}

ScanRecord Record(const LaserScan& scan) {
  ScanRecord record;
  record.Add(scan);
  return record;
}

Findings Check(const LaserScan& scan, double period = 0.025) {
  return CheckScans("/scan", Record(scan), period);
}

TEST(ScanRecord, EachRangeIsCountedOnceByWhatItSays) {
  LaserScan scan = GoodScan();
  scan.ranges = {1.0f, kNan, kInf, 31.0f, 30.0f, 0.0f, 0.001f, -1.0f, -kInf, 0.1f};
  const ScanRecord::Ranges ranges = Record(scan).ranges();
  EXPECT_EQ(ranges.all, 10u);
  EXPECT_EQ(ranges.hits, 2u);  // 1 and 0.1
  EXPECT_EQ(ranges.nan, 1u);
  EXPECT_EQ(ranges.infinite, 1u);
  EXPECT_EQ(ranges.beyond, 1u);
  EXPECT_EQ(ranges.at_maximum, 1u);
  EXPECT_EQ(ranges.zero, 1u);
  EXPECT_EQ(ranges.below, 3u);  // 0.001, -1, -Inf
}

TEST(ScanRecord, TheUsualShapeIsTheMostFrequent) {
  ScanRecord record;
  LaserScan cut = GoodScan();
  cut.ranges.resize(36);
  record.Add(cut);
  record.Add(GoodScan());
  record.Add(GoodScan());
  EXPECT_EQ(record.UsualBeams(), 271u);
  EXPECT_EQ(record.unusual(), 1u);
  EXPECT_NEAR(record.FieldOfView(), 1.5 * M_PI, 1e-9);
  EXPECT_NEAR(record.SweepTime(), 0.018, 1e-9);
  EXPECT_TRUE(Tells(CheckScans("/scan", record, 0.025), "1 scan with another number of beams"));
}

TEST(DescribeScans, TellsBeamsAnglesRangesAndSweep) {
  EXPECT_EQ(DescribeScans(Record(GoodScan())),
            "271 beams, -135 to 135 deg, every 1 deg; 0.1 to 30 m, 100 % hits; sweep 18 ms");
  LaserScan clockwise = GoodScan();
  clockwise.angle_min = 0.75 * M_PI;
  clockwise.angle_increment = -M_PI / 180.0;
  clockwise.time_increment = 0.0;
  EXPECT_EQ(DescribeScans(Record(clockwise)),
            "271 beams, 135 to -135 deg, every 1 deg; 0.1 to 30 m, 100 % hits; sweep time unknown");
}

TEST(CheckScans, AGoodScanGivesNothing) { EXPECT_TRUE(Check(GoodScan()).empty()); }

TEST(CheckScans, RangeLimitsTheWrongWayRound) {
  LaserScan scan = GoodScan();
  scan.range_max = 0.0;
  EXPECT_EQ(FindingWith(Check(scan), "is not below range_max").severity, Severity::kError);
}

TEST(CheckScans, ANarrowFieldOfView) {
  LaserScan scan = GoodScan();
  scan.ranges.resize(91);
  EXPECT_TRUE(Tells(Check(scan), "cover only 90 deg"));
}

TEST(CheckScans, SweepThatIsUnknownOrTooLong) {
  LaserScan scan = GoodScan();
  scan.time_increment = 0.0;
  EXPECT_TRUE(Tells(Check(scan), "time_increment is 0"));
  scan.time_increment = 0.030 / 270.0;
  EXPECT_TRUE(Tells(Check(scan, 0.025),
                    "a sweep takes 30 ms by time_increment, but scans come "
                    "every 25 ms"));
  EXPECT_TRUE(Check(scan, 0.030).empty());
  EXPECT_TRUE(Check(scan, 0.0).empty());  // a period that is not known contradicts nothing
}

TEST(CheckScans, NoReturnsAreNamedMostFrequentFirst) {
  LaserScan scan = GoodScan();
  scan.ranges.assign(100, 2.0f);
  scan.angle_increment = 2.7 * M_PI / 180.0;
  scan.time_increment = 0.018 / 99.0;
  for (int i = 0; i < 30; ++i) scan.ranges[i] = 0.0f;
  for (int i = 30; i < 35; ++i) scan.ranges[i] = kNan;
  const Finding legacy = FindingWith(Check(scan), "0 (30 % of all), NaN (5 % of all)");
  EXPECT_EQ(legacy.severity, Severity::kNote);
  EXPECT_NE(legacy.advice.find("clear_to_max_legacy"), std::string::npos);
  for (int i = 0; i < 35; ++i) scan.ranges[i] = kInf;
  const Finding by_rep = FindingWith(Check(scan), "+Inf (35 % of all)");
  EXPECT_NE(by_rep.advice.find("clear_to_max"), std::string::npos);
  EXPECT_EQ(by_rep.advice.find("clear_to_max_legacy"), std::string::npos);
}

TEST(CheckScans, RangeMaxThatMeansNothingSeen) {
  LaserScan scan = GoodScan();
  for (int i = 0; i < 100; ++i) scan.ranges[i] = 30.0f;
  EXPECT_EQ(FindingWith(Check(scan), "range_max counts as a hit").severity, Severity::kWarning);
}

TEST(CheckScans, FewHits) {
  LaserScan scan = GoodScan();
  for (std::size_t i = 0; i < 230; ++i) scan.ranges[i] = kNan;
  EXPECT_TRUE(Tells(Check(scan), "only 15 % of the beams hit something"));  // 41 of 271
}

}  // namespace
}  // namespace scan_image_slam
