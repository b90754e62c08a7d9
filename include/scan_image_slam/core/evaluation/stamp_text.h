#pragma once

#include "scan_image_slam/core/sensor/stamp.h"

#include <optional>
#include <string>

namespace scan_image_slam {

/// Reads a decimal number of seconds, e.g. `1700000000.018422` or `1.7e9`, digit by digit: a double
/// would lose up to 120 ns of today's time. Digits beyond the nanosecond are rounded. Nothing if
/// the text is not a number or does not fit into a Stamp (292 years).
std::optional<Stamp> ParseStamp(const std::string& seconds);

/// Seconds with nine decimals, e.g. `1700000000.018422000`; ParseStamp gives the same Stamp back.
std::string FormatStamp(Stamp stamp);

}  // namespace scan_image_slam
