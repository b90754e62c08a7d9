#include "scan_image_slam/core/recording/number_text.h"

#include <cmath>
#include <iomanip>
#include <sstream>

namespace scan_image_slam {

std::string NumberText(double value, int decimals) {
  std::ostringstream stream;
  stream << std::fixed << std::setprecision(decimals) << value;
  std::string text = stream.str();
  if (text.find('.') != std::string::npos) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
  }
  return text == "-0" ? "0" : text;
}

std::string DurationText(double seconds) {
  const double size = std::abs(seconds);
  if (size < 0.9995) return NumberText(seconds * 1e3, size < 0.01 ? 1 : 0) + " ms";
  if (size < 600.0) return NumberText(seconds, size < 10.0 ? 2 : 1) + " s";
  if (size < 2.0 * 86400.0) return NumberText(seconds / 60.0, 0) + " min";
  return NumberText(seconds / 86400.0, 0) + " days";
}

std::string ShareText(double share) {
  const double percent = share * 100.0;
  if (percent > 0.0 && percent < 0.5) return "less than 1 %";
  if (percent < 100.0 && percent > 99.5) return "more than 99 %";
  return NumberText(percent, 0) + " %";
}

std::string CountText(std::size_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

std::string ListText(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text.empty() ? "none" : text;
}

}  // namespace scan_image_slam
