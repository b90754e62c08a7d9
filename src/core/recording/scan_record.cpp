#include "scan_image_slam/core/recording/scan_record.h"

#include "scan_image_slam/core/geometry/pose2.h"
#include "scan_image_slam/core/recording/number_text.h"

#include <algorithm>
#include <cmath>

namespace scan_image_slam {
namespace {

constexpr double kFewHits = 0.2;         // of the beams
constexpr double kNarrow = 100.0;        // the field of view of the paper's model [deg]
constexpr double kMaxSweepShare = 1.05;  // of the period

double Share(std::size_t part, const ScanRecord::Ranges& ranges) {
  return ranges.all == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(ranges.all);
}

/// Beams without a return and how the driver says so, most frequent first.
std::vector<std::pair<std::size_t, std::string>> NoReturns(const ScanRecord::Ranges& r) {
  std::vector<std::pair<std::size_t, std::string>> kinds = {{r.nan, "NaN"},
                                                            {r.infinite, "+Inf"},
                                                            {r.beyond, "above range_max"},
                                                            {r.at_maximum, "range_max"},
                                                            {r.zero, "0"},
                                                            {r.below, "below range_min"}};
  std::stable_sort(kinds.begin(), kinds.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  while (!kinds.empty() && kinds.back().first == 0) kinds.pop_back();
  return kinds;
}

void CheckGeometry(const std::string& topic, const ScanRecord& record, Findings* findings) {
  const LaserScan& scan = record.usual();
  if (!(scan.range_min < scan.range_max)) {
    findings->push_back({Severity::kError,
                         topic + ": range_min (" + NumberText(scan.range_min, 3) +
                             " m) is not below range_max (" + NumberText(scan.range_max, 3) +
                             " m): no beam counts as a hit",
                         "set both in the driver"});
  }
  if (record.unusual() > 0) {
    findings->push_back({Severity::kNote,
                         topic + ": " + CountText(record.unusual(), "scan") +
                             " with another number of beams than " +
                             std::to_string(record.UsualBeams()),
                         "nothing: beams are told by their angles"});
  }
  if (Degrees(record.FieldOfView()) < kNarrow) {
    findings->push_back(
        {Severity::kWarning,
         topic + ": the scans cover only " + NumberText(Degrees(record.FieldOfView()), 0) + " deg",
         "set angle_min and angle_max of the driver to all the laser has"});
  }
}

void CheckSweep(const std::string& topic, const ScanRecord& record, double period,
                Findings* findings) {
  if (record.SweepTime() == 0.0) {
    findings->push_back({Severity::kWarning,
                         topic + ": time_increment is 0, so the motion during a sweep is not "
                                 "corrected; maps tear on turns",
                         "set it in the driver: time of a turn of the mirror / beams of a turn"});
  } else if (period > 0.0 && record.SweepTime() > kMaxSweepShare * period) {
    findings->push_back({Severity::kWarning,
                         topic + ": a sweep takes " + DurationText(record.SweepTime()) +
                             " by time_increment, but scans come every " + DurationText(period),
                         "correct time_increment in the driver, or set it to 0"});
  }
}

void CheckReturns(const std::string& topic, const ScanRecord& record, Findings* findings) {
  const ScanRecord::Ranges& ranges = record.ranges();
  const double hits = Share(ranges.hits, ranges);
  if (hits < kFewHits) {
    findings->push_back({Severity::kWarning,
                         topic + ": only " + ShareText(hits) + " of the beams hit something",
                         "check range_min and range_max, and whether something covers the laser"});
  }
  const auto kinds = NoReturns(ranges);
  if (kinds.empty()) return;
  std::string text = topic + ": beams without a return are ";
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    text += (i == 0 ? "" : ", ") + kinds[i].second + " (" +
            ShareText(Share(kinds[i].first, ranges)) + " of all)";
  }
  if (ranges.at_maximum > 0) {
    findings->push_back({Severity::kWarning, text + "; range_max counts as a hit there",
                         "let the driver send +Inf where nothing is seen"});
    return;
  }
  const bool says_so = ranges.infinite + ranges.beyond > ranges.nan + ranges.zero + ranges.below;
  findings->push_back({Severity::kNote, text,
                       std::string("they clear nothing in the map; mapper/no_return_policy: ") +
                           (says_so ? "clear_to_max" : "clear_to_max_legacy") +
                           " lets them, where nothing too near or too dark is about"});
}

}  // namespace

void ScanRecord::Add(const LaserScan& scan) {
  ++scans_;
  auto& shape = shapes_.try_emplace(scan.ranges.size(), scan, 0).first->second;
  ++shape.second;
  for (const float range : scan.ranges) {
    ++ranges_.all;
    if (std::isnan(range)) {
      ++ranges_.nan;
    } else if (range == 0.0f) {
      ++ranges_.zero;
    } else if (range < static_cast<float>(scan.range_min)) {
      ++ranges_.below;
    } else if (std::isinf(range)) {
      ++ranges_.infinite;
    } else if (range > static_cast<float>(scan.range_max)) {
      ++ranges_.beyond;
    } else if (range == static_cast<float>(scan.range_max)) {
      ++ranges_.at_maximum;
    } else {
      ++ranges_.hits;
    }
  }
}

std::size_t ScanRecord::UsualBeams() const {
  return std::max_element(
             shapes_.begin(), shapes_.end(),
             [](const auto& a, const auto& b) { return a.second.second < b.second.second; })
      ->first;
}

double ScanRecord::FieldOfView() const {
  const LaserScan& scan = usual();
  return std::abs(scan.angle_increment) * static_cast<double>(scan.ranges.size() - 1);
}

double ScanRecord::SweepTime() const {
  const LaserScan& scan = usual();
  return std::abs(scan.time_increment) * static_cast<double>(scan.ranges.size() - 1);
}

std::string DescribeScans(const ScanRecord& record) {
  const LaserScan& scan = record.usual();
  const double last = scan.Bearing(scan.ranges.size() - 1);
  return std::to_string(scan.ranges.size()) + " beams, " + NumberText(Degrees(scan.angle_min), 1) +
         " to " + NumberText(Degrees(last), 1) + " deg, every " +
         NumberText(Degrees(std::abs(scan.angle_increment)), 3) + " deg; " +
         NumberText(scan.range_min, 3) + " to " + NumberText(scan.range_max, 1) + " m, " +
         ShareText(Share(record.ranges().hits, record.ranges())) + " hits; sweep " +
         (record.SweepTime() > 0.0 ? DurationText(record.SweepTime()) : "time unknown");
}

Findings CheckScans(const std::string& topic, const ScanRecord& record, double period) {
  Findings findings;
  CheckGeometry(topic, record, &findings);
  CheckSweep(topic, record, period, &findings);
  CheckReturns(topic, record, &findings);
  return findings;
}

}  // namespace scan_image_slam
