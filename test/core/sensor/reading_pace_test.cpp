#include "scan_image_slam/core/sensor/reading_pace.h"

#include <initializer_list>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

constexpr Stamp kMs = 1000000;
// Stamps and arrivals are told by different clocks.
constexpr Stamp kFirst = 5000 * kMs;
constexpr Stamp kNow = 9000 * kMs;

/// After readings of these stamps [ms since the first], each of which comes at once.
ReadingPace PaceOf(std::initializer_list<int> readings) {
  ReadingPace pace;
  for (const int ms : readings) pace.Watch(kFirst + ms * kMs, kNow + ms * kMs);
  return pace;
}

TEST(ReadingPace, ForetellsNothingBeforeThreeReadings) {
  EXPECT_FALSE(PaceOf({}).Due(kFirst));
  EXPECT_FALSE(PaceOf({0}).Due(kFirst));
  EXPECT_FALSE(PaceOf({0, 20}).Due(kFirst));
  EXPECT_TRUE(PaceOf({0, 20, 40}).Due(kFirst));
}

TEST(ReadingPace, ForetellsTheReadingThatReachesAStamp) {
  const ReadingPace pace = PaceOf({0, 20, 40});
  EXPECT_EQ(pace.Due(kFirst + 40 * kMs), kNow + 40 * kMs);
  EXPECT_EQ(pace.Due(kFirst + 40 * kMs + 1), kNow + 60 * kMs);
  EXPECT_EQ(pace.Due(kFirst + 60 * kMs), kNow + 60 * kMs);
  EXPECT_EQ(pace.Due(kFirst + 61 * kMs), kNow + 80 * kMs);
}

TEST(ReadingPace, IsThatOfTheShorterOfTwoIntervals) {
  EXPECT_EQ(PaceOf({0, 20, 60}).Due(kFirst + 61 * kMs), kNow + 80 * kMs);
  EXPECT_EQ(PaceOf({0, 40, 60}).Due(kFirst + 61 * kMs), kNow + 80 * kMs);
  EXPECT_EQ(PaceOf({0, 20, 60, 100}).Due(kFirst + 101 * kMs), kNow + 140 * kMs);
}

TEST(ReadingPace, AReadingSeenTwiceIsOne) {
  ReadingPace pace = PaceOf({0, 20, 40});
  pace.Watch(kFirst + 40 * kMs, kNow + 55 * kMs);
  EXPECT_EQ(pace.Due(kFirst + 41 * kMs), kNow + 60 * kMs);
}

TEST(ReadingPace, BeginsAnewWhereTimeGoesBack) {
  EXPECT_FALSE(PaceOf({0, 20, 40, 10, 30}).Due(kFirst));
  EXPECT_EQ(PaceOf({0, 20, 40, 10, 40, 70}).Due(kFirst + 71 * kMs), kNow + 100 * kMs);
}

}  // namespace
}  // namespace scan_image_slam
