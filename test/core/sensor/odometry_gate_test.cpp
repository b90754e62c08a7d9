#include "scan_image_slam/core/sensor/odometry_gate.h"

#include <limits>
#include <memory>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

constexpr double kMaxWait = 0.02;
constexpr Stamp kMs = 1000000;
// Stamps and arrivals are told by different clocks.
constexpr Stamp kScan = 5000 * kMs;
constexpr Stamp kNow = 9000 * kMs;

void AddReading(OdometryBuffer* odometry, Stamp stamp) { odometry->Add(stamp, {}); }

class OdometryGateTest : public ::testing::Test {
 protected:
  OdometryGate<int> gate_{kMaxWait, 3};
  OdometryBuffer odometry_{OdometryOptions()};

  std::optional<int> PopAt(Stamp now) { return gate_.Pop(now, odometry_); }

  /// Readings each 30 ms, the last one 1 ms before the scan's stamp.
  void ReadEvenly() {
    for (int i = -8; i <= 0; ++i) {
      AddReading(&odometry_, kScan + (30 * i - 1) * kMs);
      EXPECT_FALSE(PopAt(kNow + 30 * i * kMs));
    }
  }

  /// Scan 1 has waited for encoders that did not come.
  void LetOneWaitInVain() {
    AddReading(&odometry_, kScan - 100 * kMs);
    gate_.Push(1, kScan, kNow);
    EXPECT_EQ(PopAt(kNow + 20 * kMs), 1);
  }
};

TEST_F(OdometryGateTest, IsEmptyAtFirst) {
  EXPECT_FALSE(PopAt(std::numeric_limits<Stamp>::max()));
  EXPECT_EQ(gate_.size(), 0U);
}

TEST_F(OdometryGateTest, AScanThatTheEncodersHaveReachedGoesAtOnce) {
  AddReading(&odometry_, kScan);
  gate_.Push(1, kScan, kNow);
  EXPECT_EQ(PopAt(kNow), 1);
  EXPECT_EQ(gate_.size(), 0U);
}

TEST_F(OdometryGateTest, AScanWaitsForTheEncodersToReachIt) {
  AddReading(&odometry_, kScan - 1);
  gate_.Push(1, kScan, kNow);
  EXPECT_FALSE(PopAt(kNow + 19 * kMs));
  EXPECT_EQ(gate_.size(), 1U);
  AddReading(&odometry_, kScan + 1);
  EXPECT_EQ(PopAt(kNow + 19 * kMs), 1);
}

TEST_F(OdometryGateTest, AScanDoesNotWaitForLong) {
  AddReading(&odometry_, kScan - kMs);
  gate_.Push(1, kScan, kNow);
  EXPECT_FALSE(PopAt(kNow + 20 * kMs - 1));
  EXPECT_EQ(PopAt(kNow + 20 * kMs), 1);
}

TEST_F(OdometryGateTest, TellsHowLongTheNextScanMayWait) {
  EXPECT_FALSE(gate_.TimeLeft(kNow));
  gate_.Push(1, kScan, kNow);
  gate_.Push(2, kScan + 25 * kMs, kNow + 5 * kMs);
  EXPECT_DOUBLE_EQ(*gate_.TimeLeft(kNow + 8 * kMs), 0.012);
  AddReading(&odometry_, kScan);
  EXPECT_EQ(PopAt(kNow + 8 * kMs), 1);
  EXPECT_DOUBLE_EQ(*gate_.TimeLeft(kNow + 8 * kMs), 0.017);
}

TEST_F(OdometryGateTest, TheFirstReadingIsWaitedForLonger) {
  gate_.Push(1, kScan, kNow);
  EXPECT_FALSE(PopAt(kNow + 150 * kMs));
  EXPECT_DOUBLE_EQ(*gate_.TimeLeft(kNow + 150 * kMs), 0.05);
  AddReading(&odometry_, kScan + 140 * kMs);
  EXPECT_EQ(PopAt(kNow + 151 * kMs), 1);
}

TEST_F(OdometryGateTest, WhereThereAreNoEncodersTheirFirstReadingIsNotWaitedFor) {
  OdometryGate<int> gate(kMaxWait, 3, false);
  gate.Push(1, kScan, kNow);
  EXPECT_FALSE(gate.Pop(kNow + 19 * kMs, odometry_));
  EXPECT_EQ(gate.Pop(kNow + 20 * kMs, odometry_), 1);
}

TEST_F(OdometryGateTest, WithoutEncodersOnlyTheFirstScanWaits) {
  gate_.Push(1, kScan, kNow);
  EXPECT_FALSE(PopAt(kNow + 199 * kMs));
  EXPECT_EQ(PopAt(kNow + 200 * kMs), 1);
  gate_.Push(2, kScan + 250 * kMs, kNow + 250 * kMs);
  EXPECT_EQ(PopAt(kNow + 250 * kMs), 2);
  // Not even after a while without a look.
  gate_.Push(3, kScan + 1250 * kMs, kNow + 1250 * kMs);
  EXPECT_FALSE(PopAt(kNow + 1269 * kMs));
  EXPECT_EQ(PopAt(kNow + 1270 * kMs), 3);
  gate_.Clear();
  gate_.Push(4, kScan + 1300 * kMs, kNow + 1300 * kMs);
  EXPECT_FALSE(PopAt(kNow + 1499 * kMs));
}

TEST_F(OdometryGateTest, SilentEncodersAreNotWaitedForTwice) {
  LetOneWaitInVain();
  for (int scan = 2; scan < 5; ++scan) {
    gate_.Push(scan, kScan + scan * kMs, kNow + 30 * kMs);
    EXPECT_EQ(PopAt(kNow + 30 * kMs), scan);
  }
}

TEST_F(OdometryGateTest, EncodersThatSpeakAgainAreWaitedForAgain) {
  LetOneWaitInVain();
  AddReading(&odometry_, kScan - 50 * kMs);
  gate_.Push(2, kScan + 25 * kMs, kNow + 25 * kMs);
  EXPECT_FALSE(PopAt(kNow + 44 * kMs));
  EXPECT_EQ(PopAt(kNow + 45 * kMs), 2);
}

TEST_F(OdometryGateTest, EncodersThatHaveReachedAScanAreWaitedForAgain) {
  LetOneWaitInVain();
  AddReading(&odometry_, kScan + 25 * kMs);
  gate_.Push(2, kScan + 25 * kMs, kNow + 25 * kMs);
  EXPECT_EQ(PopAt(kNow + 25 * kMs), 2);
  gate_.Push(3, kScan + 50 * kMs, kNow + 50 * kMs);
  EXPECT_FALSE(PopAt(kNow + 50 * kMs));
}

TEST_F(OdometryGateTest, AScanDoesNotWaitForAReadingThatWillBeLate) {
  ReadEvenly();
  gate_.Push(1, kScan, kNow + 9 * kMs);  // the next comes 21 ms later
  EXPECT_EQ(PopAt(kNow + 9 * kMs), 1);
  gate_.Push(2, kScan, kNow + 11 * kMs);  // or 19 ms
  EXPECT_FALSE(PopAt(kNow + 11 * kMs));
  AddReading(&odometry_, kScan + 29 * kMs);
  EXPECT_EQ(PopAt(kNow + 30 * kMs), 2);
  // The one after the next.
  gate_.Push(3, kScan + 69 * kMs, kNow + 69 * kMs);
  EXPECT_EQ(PopAt(kNow + 69 * kMs), 3);
  gate_.Push(4, kScan + 69 * kMs, kNow + 71 * kMs);
  EXPECT_FALSE(PopAt(kNow + 71 * kMs));
}

TEST_F(OdometryGateTest, AReadingThatIsOverdueIsWaitedFor) {
  ReadEvenly();
  gate_.Push(1, kScan, kNow + 33 * kMs);
  EXPECT_FALSE(PopAt(kNow + 52 * kMs));
  EXPECT_EQ(PopAt(kNow + 53 * kMs), 1);
}

// Of a machine with too much to do: the readings are there, too, but have not been looked at yet.
TEST_F(OdometryGateTest, TimeInWhichNobodyLookedIsNotWaited) {
  AddReading(&odometry_, kScan - 100 * kMs);
  gate_.Push(1, kScan, kNow);
  EXPECT_FALSE(PopAt(kNow));
  EXPECT_FALSE(PopAt(kNow + 300 * kMs));
  EXPECT_DOUBLE_EQ(*gate_.TimeLeft(kNow + 300 * kMs), kMaxWait);
  AddReading(&odometry_, kScan);
  EXPECT_EQ(PopAt(kNow + 301 * kMs), 1);
}

TEST_F(OdometryGateTest, AScanDoesNotWaitForeverForLooksThatComeTooLate) {
  gate_.Push(1, kScan, kNow);
  for (int look = 1; look <= 3; ++look) EXPECT_FALSE(PopAt(kNow + 300 * look * kMs));
  EXPECT_EQ(PopAt(kNow + 1200 * kMs), 1);
}

TEST_F(OdometryGateTest, EncodersAreNotSilentAfterALateLook) {
  LetOneWaitInVain();
  gate_.Push(2, kScan + 300 * kMs, kNow + 300 * kMs);
  EXPECT_FALSE(PopAt(kNow + 300 * kMs));
  EXPECT_EQ(PopAt(kNow + 320 * kMs), 2);
}

TEST_F(OdometryGateTest, ThePaceOfTheEncodersIsUnknownAfterALateLook) {
  ReadEvenly();
  AddReading(&odometry_, kScan + 29 * kMs);  // the first of those that came in the meantime
  EXPECT_FALSE(PopAt(kNow + 300 * kMs));
  gate_.Push(1, kScan + 290 * kMs, kNow + 300 * kMs);
  EXPECT_FALSE(PopAt(kNow + 300 * kMs));
}

TEST_F(OdometryGateTest, EncodersThatAreSlowAreNotLate) {
  constexpr Stamp kPeriod = 150 * kMs;
  for (int i = -8; i <= 0; ++i) {
    AddReading(&odometry_, kScan + i * kPeriod);
    EXPECT_FALSE(PopAt(kNow + i * kPeriod));
  }
  gate_.Push(1, kScan + 100 * kMs, kNow + 100 * kMs);  // the next one comes 50 ms later
  EXPECT_EQ(PopAt(kNow + 100 * kMs), 1);
}

// As they do in recordings where both have the stamps of one clock.
TEST_F(OdometryGateTest, AReadingWithTheStampOfTheScanIsWaitedFor) {
  constexpr Stamp kPeriod = 200 * kMs;
  for (int i = 0; i < 30; ++i) {
    const Stamp at = i * kPeriod + (i % 3) * 10 * kMs;
    gate_.Push(i, kScan + at, kNow + at);
    EXPECT_FALSE(PopAt(kNow + at)) << i;
    AddReading(&odometry_, kScan + at);
    EXPECT_EQ(PopAt(kNow + at), i);
  }
}

TEST_F(OdometryGateTest, ScansLeaveInTheOrderInWhichTheyCame) {
  AddReading(&odometry_, kScan + 5 * kMs);
  gate_.Push(1, kScan + 10 * kMs, kNow);
  gate_.Push(2, kScan, kNow);  // reached, but not its turn
  EXPECT_FALSE(PopAt(kNow));
  AddReading(&odometry_, kScan + 10 * kMs);
  EXPECT_EQ(PopAt(kNow), 1);
  EXPECT_EQ(PopAt(kNow), 2);
}

TEST_F(OdometryGateTest, TooManyScansPushOutTheOldest) {
  for (int scan = 1; scan <= 5; ++scan) gate_.Push(scan, kScan, kNow);
  EXPECT_EQ(gate_.size(), 3U);
  EXPECT_EQ(gate_.dropped(), 2);
  AddReading(&odometry_, kScan);
  for (int scan = 3; scan <= 5; ++scan) EXPECT_EQ(PopAt(kNow), scan);
}

TEST_F(OdometryGateTest, ScansThatAreTakenAreNotDropped) {
  AddReading(&odometry_, kScan);
  for (int scan = 1; scan <= 5; ++scan) {
    gate_.Push(scan, kScan, kNow);
    EXPECT_EQ(PopAt(kNow), scan);
  }
  EXPECT_EQ(gate_.dropped(), 0);
}

TEST_F(OdometryGateTest, ClearForgetsTheScansAndTheSilence) {
  LetOneWaitInVain();
  gate_.Push(2, kScan, kNow);
  gate_.Clear();
  EXPECT_EQ(gate_.size(), 0U);
  gate_.Push(3, kScan, kNow);
  EXPECT_FALSE(PopAt(kNow));
}

TEST(OdometryGate, HandsOverItemsThatCannotBeCopied) {
  OdometryGate<std::unique_ptr<int>> gate(kMaxWait, 3);
  OdometryBuffer odometry{OdometryOptions()};
  AddReading(&odometry, kScan);
  gate.Push(std::make_unique<int>(7), kScan, kNow);
  const auto item = gate.Pop(kNow, odometry);
  ASSERT_TRUE(item && *item);
  EXPECT_EQ(**item, 7);
}

}  // namespace
}  // namespace scan_image_slam
