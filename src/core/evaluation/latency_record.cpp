#include "scan_image_slam/core/evaluation/latency_record.h"

#include <algorithm>

namespace scan_image_slam {
namespace {

constexpr std::size_t kMaxEarly = 20;  // as many scans as may be on their way

}  // namespace

void LatencyRecord::AddScan(Stamp stamp, Stamp arrival) {
  if (closed_) return;
  const auto early = std::find(early_.begin(), early_.end(), stamp);
  if (early == early_.end()) {
    waiting_.push_back({stamp, arrival});
    return;
  }
  early_.erase(early);
  latencies_.push_back(0.0);
}

void LatencyRecord::AddPose(Stamp stamp, Stamp arrival) {
  const auto scan = std::find_if(waiting_.begin(), waiting_.end(),
                                 [&](const Arrived& waiting) { return waiting.stamp == stamp; });
  if (scan != waiting_.end()) {
    if (begun_) dropped_ += static_cast<std::size_t>(scan - waiting_.begin());
    latencies_.push_back(static_cast<double>(arrival - scan->arrival) / 1e6);
    waiting_.erase(waiting_.begin(), scan + 1);
    begun_ = true;
  } else if (begun_ && !closed_) {
    early_.push_back(stamp);
    if (early_.size() > kMaxEarly) {
      early_.pop_front();
      ++strangers_;
    }
  }
}

std::vector<std::size_t> CountUpTo(const std::vector<double>& values,
                                   const std::vector<double>& bounds) {
  std::vector<std::size_t> counts(bounds.size() + 1, 0);
  for (const double value : values) {
    ++counts[std::lower_bound(bounds.begin(), bounds.end(), value) - bounds.begin()];
  }
  return counts;
}

}  // namespace scan_image_slam
