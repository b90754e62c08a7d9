#include "scan_image_slam/core/evaluation/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace scan_image_slam {

Statistics Summarize(std::vector<double> values) {
  if (values.empty()) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    return {0, kNone, kNone, kNone, kNone, kNone};
  }
  std::sort(values.begin(), values.end());
  const double count = static_cast<double>(values.size());
  double sum = 0.0;
  double sum_of_squares = 0.0;
  for (const double value : values) {
    sum += value;
    sum_of_squares += value * value;
  }
  Statistics statistics;
  statistics.count = values.size();
  statistics.mean = sum / count;
  double sum_of_deviations = 0.0;
  for (const double value : values) {
    sum_of_deviations += (value - statistics.mean) * (value - statistics.mean);
  }
  statistics.standard_deviation = std::sqrt(sum_of_deviations / count);
  statistics.median = (values[(values.size() - 1) / 2] + values[values.size() / 2]) / 2.0;
  statistics.rms = std::sqrt(sum_of_squares / count);
  statistics.max = values.back();
  return statistics;
}

double Percentile(std::vector<double> values, double percent) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const double rank = std::ceil(percent * static_cast<double>(values.size()) / 100.0);
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(std::max(rank, 1.0)) - 1;
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

}  // namespace scan_image_slam
