#include "scan_image_slam/core/recording/stamp_record.h"

#include "scan_image_slam/core/recording/number_text.h"

#include <algorithm>
#include <cmath>

namespace scan_image_slam {
namespace {

constexpr double kGapPeriods = 3.5;   // of the usual period make a gap
constexpr double kMinGap = 0.3;       // shorter ones do no harm [s]
constexpr double kFuture = 0.005;     // stamps may be so far ahead by jitter [s]
constexpr double kDrift = 0.02;       // [s]
constexpr double kLate = 0.1;         // more than measuring and sending usually take [s]
constexpr double kOtherClock = 0.5;   // no delay explains that [s]
constexpr double kBeginLateBy = 2.0;  // [s]

double Median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

const char kSynchronise[] = "synchronise the clocks (chrony, or the driver's own option)";

}  // namespace

void StampRecord::Add(Stamp stamp, Stamp recorded) {
  if (stamp == 0) {
    ++unstamped_;
  } else if (!usable_.empty() && stamp < usable_.back().stamp) {
    ++backward_;
    largest_step_back_ = std::max(largest_step_back_, Seconds(usable_.back().stamp - stamp));
  } else if (!usable_.empty() && stamp == usable_.back().stamp) {
    ++repeated_;
  } else {
    usable_.push_back({stamp, recorded});
  }
}

double StampRecord::Period() const {
  std::vector<double> periods;
  for (std::size_t i = 1; i < usable_.size(); ++i) {
    periods.push_back(Seconds(usable_[i].stamp - usable_[i - 1].stamp));
  }
  return Median(std::move(periods));
}

double StampRecord::MeanRate() const {
  return Duration() > 0.0 ? static_cast<double>(usable_.size() - 1) / Duration() : 0.0;
}

std::vector<StampRecord::Gap> StampRecord::Gaps() const {
  const double shortest = std::max(kGapPeriods * Period(), kMinGap);
  std::vector<Gap> gaps;
  for (std::size_t i = 1; i < usable_.size(); ++i) {
    const double seconds = Seconds(usable_[i].stamp - usable_[i - 1].stamp);
    if (seconds > shortest) gaps.push_back({Seconds(usable_[i - 1].stamp - first()), seconds});
  }
  return gaps;
}

double StampRecord::MedianDelay(std::size_t begin, std::size_t end) const {
  std::vector<double> delays;
  for (std::size_t i = begin; i < end; ++i) {
    delays.push_back(Seconds(usable_[i].recorded - usable_[i].stamp));
  }
  return Median(std::move(delays));
}

double StampRecord::Delay() const { return MedianDelay(0, usable_.size()); }

double StampRecord::DelayDrift() const {
  const std::size_t tenth = std::max<std::size_t>(1, usable_.size() / 10);
  if (usable_.size() < 2 * tenth) return 0.0;
  return MedianDelay(usable_.size() - tenth, usable_.size()) - MedianDelay(0, tenth);
}

Findings CheckStamps(const std::string& topic, const StampRecord& record) {
  Findings findings;
  const double messages = static_cast<double>(record.messages());
  if (record.unstamped() > 0) {
    const bool all = record.unstamped() == record.messages();
    findings.push_back({all ? Severity::kError : Severity::kWarning,
                        topic + ": " +
                            ShareText(static_cast<double>(record.unstamped()) / messages) +
                            " of the messages have a stamp of zero; they are left out",
                        "let the driver set header.stamp"});
  }
  if (record.backward() > 0) {
    const double share = static_cast<double>(record.backward()) / messages;
    findings.push_back(
        {share > 0.01 ? Severity::kError : Severity::kWarning,
         topic + ": stamps jump back, by up to " + DurationText(record.largest_step_back()) + "; " +
             CountText(record.backward(), "message") + " (" + ShareText(share) + ") are left out",
         "let only one driver publish the topic, and don't set the clock while "
         "recording"});
  }
  if (record.repeated() > 0) {
    findings.push_back({Severity::kNote,
                        topic + ": " + CountText(record.repeated(), "message") +
                            " with the stamp of the one before; they are left out",
                        ""});
  }
  const std::vector<StampRecord::Gap> gaps = record.Gaps();
  if (!gaps.empty()) {
    const auto longest =
        std::max_element(gaps.begin(), gaps.end(),
                         [](const auto& a, const auto& b) { return a.seconds < b.seconds; });
    findings.push_back({Severity::kWarning,
                        topic + ": " + CountText(gaps.size(), "gap") + ", the longest " +
                            DurationText(longest->seconds) + " long, " +
                            DurationText(longest->begin) + " after the first message",
                        "look for a loose cable, a full disk (rosbag: buffer exceeded) or a busy "
                        "computer; a robot that turns quickly in a gap may be lost"});
  }
  if (std::abs(record.DelayDrift()) > kDrift) {
    findings.push_back({Severity::kWarning,
                        topic + ": its stamps move against the time of recording, by " +
                            DurationText(record.DelayDrift()) + " from beginning to end",
                        std::string("its clock runs at another speed: ") + kSynchronise});
  }
  return findings;
}

Findings CheckRecordingClock(const std::string& topic, const StampRecord& record) {
  if (std::abs(record.Delay()) < kOtherClock) return {};
  return {
      {Severity::kNote,
       topic + ": stamps and times of recording are " + DurationText(std::abs(record.Delay())) +
           " apart",
       "harmless as long as this is so for all sensors; otherwise " + std::string(kSynchronise)}};
}

Findings CompareStamps(const std::string& scan_topic, const StampRecord& scans,
                       const std::string& topic, const StampRecord& record) {
  if (scans.usable() == 0 || record.usable() == 0) return {};
  if (record.last() < scans.first() || record.first() > scans.last()) {
    return {{Severity::kError,
             topic + ": its stamps and those of " + scan_topic +
                 " have no time in common, they are " +
                 DurationText(std::abs(Seconds(record.first() - scans.first()))) + " apart",
             kSynchronise}};
  }
  Findings findings;
  const double apart = record.Delay() - scans.Delay();
  if (std::abs(apart) > kLate) {
    findings.push_back({std::abs(apart) > kOtherClock ? Severity::kError : Severity::kWarning,
                        topic + ": " + DurationText(record.Delay()) +
                            " from stamp to recording, while " + scan_topic + " has " +
                            DurationText(scans.Delay()) + ": a slow sender, or other clocks",
                        kSynchronise});
  } else if (record.Delay() < -kFuture && scans.Delay() > -kFuture) {
    findings.push_back({Severity::kWarning,
                        topic + ": stamps are " + DurationText(-record.Delay()) +
                            " later than their recording, those of " + scan_topic + " are not",
                        std::string("its clock is ahead: ") + kSynchronise});
  }
  const double late = Seconds(record.first() - scans.first());
  const double early = Seconds(scans.last() - record.last());
  if (late > kBeginLateBy) {
    findings.push_back(
        {Severity::kNote, topic + ": begins " + DurationText(late) + " after " + scan_topic, ""});
  }
  if (early > kBeginLateBy) {
    findings.push_back(
        {Severity::kNote, topic + ": ends " + DurationText(early) + " before " + scan_topic, ""});
  }
  return findings;
}

}  // namespace scan_image_slam
