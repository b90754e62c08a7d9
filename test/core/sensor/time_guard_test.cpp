#include "scan_image_slam/core/sensor/time_guard.h"

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

using Verdict = TimeGuard::Verdict;

constexpr Stamp kSecond = 1000000000;
constexpr Stamp kPeriod = kSecond / 10;

/// A stream of which one message comes each tenth of a second.
class TimeGuardTest : public ::testing::Test {
 protected:
  TimeGuardTest() {
    for (int i = 0; i < 20; ++i) EXPECT_EQ(Next(), Verdict::kAdvances);
  }
  /// Stamped so much later than it comes.
  Verdict Next(Stamp lead = 0, bool simulated = false) {
    now_ += kPeriod;
    return guard_.Check(now_ + lead, now_, simulated);
  }

  TimeGuard guard_;
  Stamp now_ = 1000 * kSecond;
};

TEST_F(TimeGuardTest, OneThatLeapsAheadIsLeftOutAndHarmsNoOther) {
  EXPECT_EQ(Next(3600 * kSecond), Verdict::kAhead);
  EXPECT_EQ(Next(), Verdict::kAdvances);
}

TEST_F(TimeGuardTest, AGapIsNoLeap) {
  now_ += 60 * kSecond;
  EXPECT_EQ(Next(), Verdict::kAdvances);
}

TEST_F(TimeGuardTest, NorIsItWithAClockThatIsFastAllAlong) {
  TimeGuard fast;
  const Stamp lead = 30 * kSecond;
  EXPECT_EQ(fast.Check(now_ + lead, now_, false), Verdict::kAdvances);
  now_ += 5 * kSecond;
  EXPECT_EQ(fast.Check(now_ + lead, now_, false), Verdict::kAdvances);
}

TEST_F(TimeGuardTest, IfTheClockHereIsSetBackNothingIsLeftOut) {
  now_ -= 5 * kSecond;
  for (int i = 0; i < 5; ++i) EXPECT_EQ(Next(5 * kSecond), Verdict::kAdvances) << i;
}

TEST_F(TimeGuardTest, OneThatRepeatsIsStale) {
  EXPECT_EQ(guard_.Check(now_, now_ + 1, false), Verdict::kStale);
  EXPECT_EQ(Next(), Verdict::kAdvances);
}

TEST_F(TimeGuardTest, AClockThatWasSetMakesAllSoAndIsBelievedInTheEnd) {
  for (int i = 1; i < 40; ++i) EXPECT_EQ(Next(-100 * kSecond), Verdict::kStale) << i;
  EXPECT_EQ(Next(-100 * kSecond), Verdict::kRestarts);
  EXPECT_EQ(Next(-100 * kSecond), Verdict::kAdvances);
}

TEST_F(TimeGuardTest, SimulatedTimeThatGoesBackStartsOverAtOnce) {
  now_ -= 500 * kSecond;
  EXPECT_EQ(Next(500 * kSecond, true), Verdict::kStale) << "sent before";
  EXPECT_EQ(Next(0, true), Verdict::kRestarts);
  EXPECT_EQ(Next(0, true), Verdict::kAdvances);
}

}  // namespace
}  // namespace scan_image_slam
