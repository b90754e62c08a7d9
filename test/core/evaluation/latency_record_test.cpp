#include "scan_image_slam/core/evaluation/latency_record.h"

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

constexpr Stamp kMillisecond = 1000000;

/// Scans with the stamps 0, 1, 2, ... that arrive every 25 ms.
class LatencyRecordTest : public testing::Test {
 protected:
  void Scan(int number) { record_.AddScan(number, Arrival(number)); }
  /// `late` after its scan [ms].
  void Pose(int number, int late) {
    record_.AddPose(number, Arrival(number) + late * kMillisecond);
  }
  static Stamp Arrival(int number) { return 25 * kMillisecond * number; }

  LatencyRecord record_;
};

using Latencies = std::vector<double>;

TEST_F(LatencyRecordTest, IsTheTimeFromScanToPose) {
  Scan(1);
  Pose(1, 3);
  Scan(2);
  Scan(3);
  Pose(2, 40);
  Pose(3, 15);
  EXPECT_EQ(record_.latencies(), Latencies({3.0, 40.0, 15.0}));
  EXPECT_EQ(record_.dropped(), 0u);
  EXPECT_EQ(record_.strangers(), 0u);
}

TEST_F(LatencyRecordTest, ScansThatAreOvertakenAreDropped) {
  Scan(1);
  Pose(1, 1);
  for (const int number : {2, 3, 4, 5}) Scan(number);
  Pose(4, 2);
  EXPECT_EQ(record_.latencies(), Latencies({1.0, 2.0}));
  EXPECT_EQ(record_.dropped(), 2u);
  EXPECT_EQ(record_.waiting(), 1u);
}

TEST_F(LatencyRecordTest, BeginsWithTheFirstPose) {
  Pose(1, 1);  // its scan came before anybody listened
  for (const int number : {2, 3, 4}) Scan(number);
  EXPECT_FALSE(record_.begun());
  EXPECT_EQ(record_.waiting(), 0u);
  Pose(4, 6);
  EXPECT_TRUE(record_.begun());
  EXPECT_EQ(record_.latencies(), Latencies({6.0}));
  EXPECT_EQ(record_.dropped(), 0u);
  EXPECT_EQ(record_.strangers(), 0u);
}

TEST_F(LatencyRecordTest, APoseMayArriveBeforeItsScan) {
  Scan(1);
  Pose(1, 1);
  Pose(2, 0);
  EXPECT_EQ(record_.strangers(), 1u);
  Scan(2);
  EXPECT_EQ(record_.latencies(), Latencies({1.0, 0.0}));
  EXPECT_EQ(record_.strangers(), 0u);
  EXPECT_EQ(record_.waiting(), 0u);
}

TEST_F(LatencyRecordTest, PosesWithoutAScanAreCountedAndForgotten) {
  Scan(1);
  Pose(1, 1);
  for (int number = 1000; number < 2000; ++number) Pose(number, 0);
  EXPECT_EQ(record_.strangers(), 1000u);
  Scan(1000);  // too late: it is a scan of its own
  EXPECT_EQ(record_.waiting(), 1u);
}

TEST_F(LatencyRecordTest, ClosedItCountsThePosesOfKnownScansOnly) {
  Scan(1);
  Pose(1, 1);
  Scan(2);
  Scan(3);
  record_.Close();
  Scan(4);
  Pose(3, 30);
  Pose(4, 1);
  EXPECT_EQ(record_.latencies(), Latencies({1.0, 30.0}));
  EXPECT_EQ(record_.dropped(), 1u);
  EXPECT_EQ(record_.waiting(), 0u);
  EXPECT_EQ(record_.strangers(), 0u);
}

TEST_F(LatencyRecordTest, GoesOnWhenARecordingBeginsAnew) {
  Scan(100);
  Pose(100, 1);
  Scan(101);
  record_.AddScan(1, Arrival(102));
  record_.AddPose(101, Arrival(103));
  record_.AddPose(1, Arrival(103));
  EXPECT_EQ(record_.latencies(), Latencies({1.0, 50.0, 25.0}));
  EXPECT_EQ(record_.dropped(), 0u);
}

TEST(CountUpTo, BoundsBelongToTheValuesBelow) {
  EXPECT_EQ(CountUpTo({0.0, 1.0, 1.1, 5.0, 5.0, 6.0, 100.0}, {1.0, 5.0, 7.0}),
            (std::vector<std::size_t>{2, 3, 1, 1}));
  EXPECT_EQ(CountUpTo({}, {1.0}), (std::vector<std::size_t>{0, 0}));
}

}  // namespace
}  // namespace scan_image_slam
