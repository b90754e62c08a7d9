#include "scan_image_slam/core/sensor/reading_pace.h"

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

constexpr Stamp kMs = 1000000;
// Stamps and arrivals are told by different clocks.
constexpr Stamp kLast = 5000 * kMs;
constexpr Stamp kNow = 9000 * kMs;
constexpr int kEnough = 9;

/// So many readings, each 20 ms, the last one just now.
ReadingPace EvenPace(int readings) {
  ReadingPace pace;
  for (int i = readings - 1; i >= 0; --i) pace.Watch(kLast - 20 * i * kMs, kNow - 20 * i * kMs);
  return pace;
}

TEST(ReadingPace, ForetellsTheReadingThatReachesAStamp) {
  const ReadingPace pace = EvenPace(kEnough);
  EXPECT_EQ(pace.Due(kLast + 1 * kMs), kNow + 20 * kMs);
  EXPECT_EQ(pace.Due(kLast + 20 * kMs), kNow + 20 * kMs);
  EXPECT_EQ(pace.Due(kLast + 26 * kMs), kNow + 40 * kMs);
  EXPECT_EQ(pace.Due(kLast + 66 * kMs), kNow + 80 * kMs);
}

// A scan may have the stamp of a reading that comes a little later than is usual.
TEST(ReadingPace, AStampJustAfterAReadingMayBeThatOfTheReading) {
  EXPECT_EQ(EvenPace(kEnough).Due(kLast + 24 * kMs), kNow + 20 * kMs);
}

TEST(ReadingPace, ForetellsNothingOfFewReadings) {
  EXPECT_FALSE(ReadingPace().Due(kLast));
  EXPECT_FALSE(EvenPace(kEnough - 1).Due(kLast));
}

TEST(ReadingPace, ForetellsNothingOfReadingsThatComeUnevenly) {
  ReadingPace pace = EvenPace(kEnough);
  pace.Watch(kLast + 24 * kMs, kNow + 24 * kMs);
  EXPECT_TRUE(pace.Due(kLast + 25 * kMs));
  pace.Watch(kLast + 50 * kMs, kNow + 50 * kMs);  // 26 ms later
  EXPECT_FALSE(pace.Due(kLast + 51 * kMs));
}

TEST(ReadingPace, ForetellsTheEarliestArrival) {
  ReadingPace pace = EvenPace(kEnough);
  pace.Watch(kLast + 20 * kMs, kNow + 23 * kMs);
  pace.Watch(kLast + 40 * kMs, kNow + 40 * kMs);  // 17 ms later
  pace.Watch(kLast + 60 * kMs, kNow + 60 * kMs);
  EXPECT_EQ(pace.Due(kLast + 61 * kMs), kNow + 77 * kMs);
}

TEST(ReadingPace, AStampOfAnotherCenturyIsFarAhead) {
  ReadingPace pace;
  for (int i = 0; i < kEnough; ++i)
    pace.Watch(i, kNow + 20 * i * kMs);  // stamps a nanosecond apart
  const std::optional<Stamp> due = pace.Due(4'000'000'000'000'000'000);
  ASSERT_TRUE(due);
  EXPECT_GT(*due, kNow + 10000 * kMs);
}

TEST(ReadingPace, AReadingSeenTwiceIsOne) {
  ReadingPace pace = EvenPace(kEnough);
  pace.Watch(kLast, kNow + 15 * kMs);
  EXPECT_EQ(pace.Due(kLast + 1 * kMs), kNow + 20 * kMs);
}

TEST(ReadingPace, ForetellsNothingWhereTimeGoesBack) {
  ReadingPace pace = EvenPace(kEnough);
  pace.Watch(kLast - 1000 * kMs, kNow + 20 * kMs);
  EXPECT_FALSE(pace.Due(kLast));
}

}  // namespace
}  // namespace scan_image_slam
