#pragma once

#include <string>
#include <vector>

namespace scan_image_slam {

/// A number for people to read: so many decimals, without zeros at the end.
std::string NumberText(double value, int decimals);

/// A time span with a fitting unit: `12 ms`, `3.2 s`, `14 min` [s].
std::string DurationText(double seconds);

/// A share as `45 %`; what is not zero is never called `0 %`.
std::string ShareText(double share);

/// `1 scan`, `2 scans`.
std::string CountText(std::size_t count, const std::string& noun);

/// `a, b, c`; `none` if there are no words.
std::string ListText(const std::vector<std::string>& words);

}  // namespace scan_image_slam
