#include "latency_report.h"

#include "scan_image_slam/core/evaluation/statistics.h"

#include <algorithm>
#include <array>
#include <cstdio>

namespace scan_image_slam {
namespace {

const std::vector<double> kBounds = {1, 2, 3, 5, 7, 10, 15, 20, 30, 50, 100, 200, 500, 1000};

struct NamedPercent {
  const char* name;
  double percent;
};
constexpr std::array<NamedPercent, 4> kPercents = {
    {{"p50", 50.0}, {"p90", 90.0}, {"p99", 99.0}, {"max", 100.0}}};

template <typename... Values>
std::string Format(const char* format, Values... values) {
  char text[200];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

/// Share of one core [%].
double CpuPercent(const NodeLoad& load, double seconds) {
  return seconds > 0.0 ? 100.0 * load.cpu_seconds / seconds : 0.0;
}

double CpuPerScan(const NodeLoad& load, std::size_t scans) {
  return scans > 0 ? 1e3 * load.cpu_seconds / static_cast<double>(scans) : 0.0;
}

NodeLoad Sum(const std::map<std::string, NodeLoad>& loads) {
  NodeLoad sum;
  for (const auto& [name, load] : loads) {
    sum.cpu_seconds += load.cpu_seconds;
    sum.memory_mb += load.memory_mb;
    sum.peak_memory_mb += load.peak_memory_mb;
    sum.threads += load.threads;
    sum.open_files += load.open_files;
  }
  return sum;
}

std::string HistogramText(const std::vector<double>& latencies) {
  constexpr std::size_t kWidth = 50;
  const std::vector<std::size_t> counts = CountUpTo(latencies, kBounds);
  const std::size_t most = *std::max_element(counts.begin(), counts.end());
  std::size_t rows = counts.size();
  while (rows > 0 && counts[rows - 1] == 0) --rows;
  std::size_t first = 0;
  while (first < rows && counts[first] == 0) ++first;
  std::string text = "\nup to [ms]     scans\n";
  for (std::size_t i = first; i < rows; ++i) {
    const std::string bound = i < kBounds.size() ? Format("%10.0f", kBounds[i]) : "      more";
    const std::size_t bar = (counts[i] * kWidth + most - 1) / most;  // what is not 0 is seen
    text += bound + Format("%10zu  ", counts[i]) + std::string(bar, '#') + "\n";
  }
  return text;
}

std::string LoadText(const std::string& name, const NodeLoad& load, const LatencyPeriod& period) {
  return Format("%-30s %8.1f %12.2f %10.0f %10.0f %8d %8d\n", name.c_str(),
                CpuPercent(load, period.seconds), CpuPerScan(load, period.scans), load.memory_mb,
                load.peak_memory_mb, load.threads, load.open_files);
}

nlohmann::json LoadsJson(const LatencyPeriod& period) {
  nlohmann::json nodes = nlohmann::json::object();
  for (const auto& [name, load] : period.loads) {
    nodes[name] = {{"cpu_percent", CpuPercent(load, period.seconds)},
                   {"cpu_ms_per_scan", CpuPerScan(load, period.scans)},
                   {"memory_mb", load.memory_mb},
                   {"peak_memory_mb", load.peak_memory_mb},
                   {"threads", load.threads},
                   {"open_files", load.open_files}};
  }
  return nodes;
}

nlohmann::json PeriodJson(const LatencyPeriod& period) {
  nlohmann::json latency = nlohmann::json::object();
  for (const NamedPercent& p : kPercents) {
    latency[p.name] = Percentile(period.latencies, p.percent);
  }
  return {{"seconds", period.seconds},
          {"scans", period.scans},
          {"dropped", period.dropped},
          {"latency_ms", latency},
          {"nodes", LoadsJson(period)}};
}

}  // namespace

std::string ReportText(const LatencyPeriod& whole, const OddPoses& odd) {
  std::string text =
      Format("%.1f s, %zu scans (%.1f per second), %zu of them without a pose\n", whole.seconds,
             whole.scans, static_cast<double>(whole.scans) / whole.seconds, whole.dropped);
  if (odd.without_scan > 0) text += Format("%zu poses without a scan\n", odd.without_scan);
  if (odd.not_finite > 0) text += Format("%zu poses that are not finite\n", odd.not_finite);
  text += "from scan to pose [ms]:";
  for (const NamedPercent& p : kPercents) {
    text += Format("  %s %.1f", p.name, Percentile(whole.latencies, p.percent));
  }
  text += "\n" + HistogramText(whole.latencies);
  text += Format("\n%-30s %8s %12s %10s %10s %8s %8s\n", "node", "core [%]", "ms per scan", "MB",
                 "peak MB", "threads", "files");
  for (const auto& [name, load] : whole.loads) text += LoadText(name, load, whole);
  return text + LoadText("all", Sum(whole.loads), whole);
}

nlohmann::json ReportJson(const LatencyPeriod& whole, const OddPoses& odd,
                          const std::vector<LatencyPeriod>& periods) {
  nlohmann::json report = PeriodJson(whole);
  report["poses_without_scan"] = odd.without_scan;
  report["poses_not_finite"] = odd.not_finite;
  const std::vector<std::size_t> counts = CountUpTo(whole.latencies, kBounds);
  for (std::size_t i = 0; i < counts.size(); ++i) {
    nlohmann::json bound = nullptr;  // above all bounds
    if (i < kBounds.size()) bound = kBounds[i];
    report["histogram"].push_back({{"up_to_ms", bound}, {"scans", counts[i]}});
  }
  report["periods"] = nlohmann::json::array();
  for (const LatencyPeriod& period : periods) report["periods"].push_back(PeriodJson(period));
  return report;
}

}  // namespace scan_image_slam
