#pragma once

#include <cstddef>
#include <vector>

namespace scan_image_slam {

/// Summary of errors, in their unit; NaN where there are none.
struct Statistics {
  std::size_t count = 0;
  double mean = 0.0;
  double standard_deviation = 0.0;  ///< divided by the number of values
  double median = 0.0;              ///< mean of the two in the middle if their number is even
  double rms = 0.0;
  double max = 0.0;
};

Statistics Summarize(std::vector<double> values);

/// The smallest of the values that so many percent (above 0, at most 100) of them do not exceed;
/// NaN if there are none.
double Percentile(std::vector<double> values, double percent);

}  // namespace scan_image_slam
