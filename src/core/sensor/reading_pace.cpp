#include "scan_image_slam/core/sensor/reading_pace.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace scan_image_slam {
namespace {

constexpr std::size_t kReadings = 9;
constexpr double kEven = 1.25;  // the longest interval, by the shortest [-]
// A stamp so little after a reading may be that of the reading, in parts of an interval.
constexpr double kSlack = 0.25;
constexpr double kFar = 1000.0;  // what comes later is no nearer [intervals]

}  // namespace

void ReadingPace::Watch(Stamp newest, Stamp now) {
  if (!readings_.empty() && newest == readings_.back().stamp) return;
  readings_.push_back({newest, now});
  if (readings_.size() > kReadings) readings_.pop_front();
}

std::optional<Stamp> ReadingPace::Due(Stamp stamp) const {
  if (readings_.size() < kReadings) return std::nullopt;
  constexpr Stamp kMost = std::numeric_limits<Stamp>::max();
  Stamp shortest = kMost;
  Stamp longest = 0;
  Stamp shortest_arrival = kMost;
  for (std::size_t i = 1; i < readings_.size(); ++i) {
    const Stamp interval = readings_[i].stamp - readings_[i - 1].stamp;
    shortest = std::min(shortest, interval);
    longest = std::max(longest, interval);
    shortest_arrival = std::min(shortest_arrival, readings_[i].arrival - readings_[i - 1].arrival);
  }
  if (Seconds(longest) > kEven * Seconds(shortest)) return std::nullopt;
  const double intervals = Seconds(stamp - readings_.back().stamp) / Seconds(longest);
  const auto ahead = static_cast<Stamp>(std::clamp(std::ceil(intervals - kSlack), 1.0, kFar));
  return readings_.back().arrival + ahead * shortest_arrival;
}

}  // namespace scan_image_slam
