#include "scan_image_slam/core/recording/stamp_record.h"

#include "core/recording/findings.h"

#include <vector>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

constexpr Stamp kStart = 1'000'000'000'000;

/// Stamps at these times after the start, each recorded `delay` later [s].
StampRecord Record(const std::vector<double>& times, double delay = 0.0) {
  StampRecord record;
  for (const double t : times) {
    record.Add(kStart + FromSeconds(t), kStart + FromSeconds(t + delay));
  }
  return record;
}

std::vector<double> Every(double period, double begin, double end) {
  std::vector<double> times;
  for (int i = 0; begin + i * period < end; ++i) times.push_back(begin + i * period);
  return times;
}

std::vector<double> Join(std::vector<double> a, const std::vector<double>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

TEST(StampRecord, RateIsThatOfMostMessages) {
  // Ten periods of 0.1 s, and one of 5 s.
  const StampRecord record = Record(Join(Every(0.1, 0.0, 0.95), {5.9}));
  EXPECT_NEAR(record.Period(), 0.1, 1e-9);
  EXPECT_NEAR(record.Rate(), 10.0, 1e-6);
  EXPECT_NEAR(record.Duration(), 5.9, 1e-9);
  EXPECT_NEAR(record.MeanRate(), 10.0 / 5.9, 1e-6);
  EXPECT_EQ(record.messages(), 11u);
}

TEST(StampRecord, OneMessageHasNoRate) {
  EXPECT_EQ(Record({1.0}).Rate(), 0.0);
  EXPECT_EQ(StampRecord().Rate(), 0.0);
  EXPECT_EQ(Record({1.0}).MeanRate(), 0.0);
  EXPECT_EQ(StampRecord().Delay(), 0.0);
  EXPECT_TRUE(CheckStamps("/scan", Record({1.0})).empty());
}

TEST(StampRecord, StampsThatDoNotAdvanceAreCountedAndLeftOut) {
  StampRecord record = Record({1.0, 1.1, 1.1, 0.4, 1.05, 1.2});
  record.Add(0, kStart);
  EXPECT_EQ(record.messages(), 7u);
  EXPECT_EQ(record.usable(), 3u);
  EXPECT_EQ(record.repeated(), 1u);
  EXPECT_EQ(record.backward(), 2u);
  EXPECT_EQ(record.unstamped(), 1u);
  EXPECT_NEAR(record.largest_step_back(), 0.7, 1e-9);
  EXPECT_NEAR(record.Period(), 0.1, 1e-9);
}

TEST(StampRecord, AGapIsLongAgainstThePeriodAndInItself) {
  // 40 Hz: 0.2 s without a message are eight periods, but do no harm; 0.35 s do.
  StampRecord fast = Record(Join(Join(Every(0.025, 0.0, 0.99), {1.2}), {1.55}));
  ASSERT_EQ(fast.Gaps().size(), 1u);
  EXPECT_NEAR(fast.Gaps()[0].begin, 1.2, 1e-6);
  EXPECT_NEAR(fast.Gaps()[0].seconds, 0.35, 1e-6);
  // 2 Hz: 1.5 s are only three periods; 2 s are four.
  EXPECT_TRUE(Record(Join(Every(0.5, 0.0, 3.1), {4.5})).Gaps().empty());
  EXPECT_EQ(Record(Join(Every(0.5, 0.0, 3.1), {5.0})).Gaps().size(), 1u);
}

TEST(StampRecord, DelayIsTheMedian) {
  StampRecord record = Record(Every(0.1, 0.0, 1.0), 0.03);
  record.Add(kStart + FromSeconds(1.0), kStart + FromSeconds(4.0));  // one that was late
  EXPECT_NEAR(record.Delay(), 0.03, 1e-9);
  EXPECT_NEAR(record.DelayDrift(), 2.97, 1e-6);  // the last tenth is that one
}

TEST(CheckStamps, GoodStampsGiveNothing) {
  EXPECT_TRUE(CheckStamps("/scan", Record(Every(0.025, 0.0, 10.0), 0.03)).empty());
}

TEST(CheckStamps, ZeroStampsAreAnErrorIfAllAre) {
  StampRecord record;
  for (int i = 0; i < 10; ++i) record.Add(0, kStart + i);
  EXPECT_EQ(FindingWith(CheckStamps("/scan", record), "stamp of zero").severity, Severity::kError);
  EXPECT_TRUE(Tells(CheckStamps("/scan", record), "/scan: 100 %"));
  for (int i = 1; i < 11; ++i) record.Add(kStart + FromSeconds(0.1 * i), kStart);
  const Finding some = FindingWith(CheckStamps("/scan", record), "stamp of zero");
  EXPECT_EQ(some.severity, Severity::kWarning);
  EXPECT_NE(some.text.find("50 %"), std::string::npos) << some.text;
}

TEST(CheckStamps, JumpsBackAreAnErrorIfTheyAreMany) {
  std::vector<double> times = Every(0.1, 0.0, 20.0);
  times.insert(times.begin() + 100, 5.0);  // 4.9 s before the newest, 9.9 s
  const Finding few = FindingWith(CheckStamps("/odom", Record(times)), "jump back");
  EXPECT_EQ(few.severity, Severity::kWarning);
  EXPECT_NE(few.text.find("4.9 s"), std::string::npos) << few.text;
  times.insert(times.begin() + 100, {5.1, 5.2, 5.3});
  EXPECT_EQ(FindingWith(CheckStamps("/odom", Record(times)), "jump back").severity,
            Severity::kError);
}

TEST(CheckStamps, TheLongestGapIsTold) {
  const StampRecord record =
      Record(Join(Join(Every(0.1, 0.0, 5.05), Every(0.1, 6.0, 8.05)), Every(0.1, 11.0, 12.0)));
  const Finding gap = FindingWith(CheckStamps("/scan", record), "gap");
  EXPECT_NE(gap.text.find("2 gaps, the longest 3 s long, 8 s after"), std::string::npos)
      << gap.text;
}

TEST(CheckStamps, AClockThatRunsAway) {
  StampRecord record;
  for (int i = 0; i <= 100; ++i) {  // 1 ms per second
    record.Add(kStart + FromSeconds(i), kStart + FromSeconds(1.001 * i));
  }
  EXPECT_TRUE(Tells(CheckStamps("/scan", record), "stamps move against the time of recording"));
  StampRecord steady;
  for (int i = 0; i <= 100; ++i) {
    steady.Add(kStart + FromSeconds(i), kStart + FromSeconds(1.0001 * i));
  }
  EXPECT_TRUE(CheckStamps("/scan", steady).empty());
}

TEST(CheckRecordingClock, ALargeOffsetIsANote) {
  EXPECT_TRUE(CheckRecordingClock("/scan", Record(Every(0.1, 0.0, 10.0), 0.1)).empty());
  const Findings ahead = CheckRecordingClock("/scan", Record(Every(0.1, 0.0, 10.0), -15.0));
  EXPECT_EQ(FindingWith(ahead, "15 s apart").severity, Severity::kNote);
}

TEST(CompareStamps, UsualDelaysGiveNothing) {
  const StampRecord scans = Record(Every(0.025, 0.0, 10.0), 0.03);
  EXPECT_TRUE(
      CompareStamps("/scan", scans, "/image", Record(Every(0.033, 0.0, 10.0), 0.1)).empty());
  EXPECT_TRUE(CompareStamps("/scan", scans, "/image", StampRecord()).empty());
}

TEST(CompareStamps, OtherClocks) {
  const StampRecord scans = Record(Every(0.025, 0.0, 10.0), 0.03);
  const auto compare = [&](double delay) {
    return FindingWith(
        CompareStamps("/scan", scans, "/image", Record(Every(0.033, 0.0, 10.0), delay)),
        "from stamp to recording");
  };
  EXPECT_EQ(compare(0.2).severity, Severity::kWarning);
  EXPECT_EQ(compare(0.9).severity, Severity::kError);
  EXPECT_EQ(compare(-0.9).severity, Severity::kError);
  EXPECT_NE(compare(-0.9).text.find("-900 ms"), std::string::npos);
}

TEST(CompareStamps, AClockThatIsALittleAhead) {
  const StampRecord scans = Record(Every(0.025, 0.0, 10.0), 0.03);
  const StampRecord images = Record(Every(0.033, 0.0, 10.0), -0.02);
  EXPECT_TRUE(Tells(CompareStamps("/scan", scans, "/image", images), "20 ms later"));
  // If all are, the recorder's clock is behind, which does not matter.
  const StampRecord also_ahead = Record(Every(0.025, 0.0, 10.0), -0.01);
  EXPECT_TRUE(CompareStamps("/scan", also_ahead, "/image", images).empty());
}

TEST(CompareStamps, NoTimeInCommon) {
  const StampRecord scans = Record(Every(0.025, 0.0, 10.0));
  const StampRecord images = Record(Every(0.033, 500.0, 510.0));
  const Finding finding = FindingWith(CompareStamps("/scan", scans, "/image", images), "no time");
  EXPECT_EQ(finding.severity, Severity::kError);
  EXPECT_NE(finding.text.find("500 s apart"), std::string::npos) << finding.text;
}

TEST(CompareStamps, BeginningLateAndEndingEarly) {
  const StampRecord scans = Record(Every(0.1, 0.0, 20.0));
  const Findings findings = CompareStamps("/scan", scans, "/image", Record(Every(0.1, 4.0, 15.0)));
  EXPECT_TRUE(Tells(findings, "/image: begins 4 s after /scan"));
  EXPECT_TRUE(Tells(findings, "/image: ends 5 s before /scan"));
}

}  // namespace
}  // namespace scan_image_slam
