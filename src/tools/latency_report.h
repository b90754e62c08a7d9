#pragma once

#include "node_load.h"
#include "scan_image_slam/core/evaluation/latency_record.h"

#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace scan_image_slam {

/// What was seen in a span of time.
struct LatencyPeriod {
  double seconds = 0.0;  ///< its length [s]
  std::size_t scans = 0;
  std::size_t dropped = 0;        ///< scans without a pose
  std::vector<double> latencies;  ///< of the other scans [ms]
  std::map<std::string, NodeLoad> loads;
};

/// Poses that should not be.
struct OddPoses {
  std::size_t without_scan = 0;
  std::size_t not_finite = 0;
};

/// Tables for people: latencies with their histogram, and the load of each node.
std::string ReportText(const LatencyPeriod& whole, const OddPoses& odd);

/// The same for programs, with a line for each of the periods, in their order.
nlohmann::json ReportJson(const LatencyPeriod& whole, const OddPoses& odd,
                          const std::vector<LatencyPeriod>& periods);

}  // namespace scan_image_slam
