#pragma once

#include <cstdint>

namespace scan_image_slam {

/// Point in time: nanoseconds since the epoch of the recording [ns].
using Stamp = std::int64_t;

/// Time span in seconds, e.g. Seconds(later - earlier) [s].
constexpr double Seconds(Stamp span) { return static_cast<double>(span) * 1e-9; }

/// Seconds to nanoseconds, rounded to the nearest [ns].
constexpr Stamp FromSeconds(double seconds) {
  return static_cast<Stamp>(seconds * 1e9 + (seconds < 0 ? -0.5 : 0.5));
}

}  // namespace scan_image_slam
