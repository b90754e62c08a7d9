#pragma once

#include <string>
#include <vector>

namespace scan_image_slam {

/// How much a peculiarity of a recording matters.
enum class Severity {
  kError,    ///< a sensor can't be used
  kWarning,  ///< the result suffers
  kNote,     ///< worth knowing
};

/// What is missing or odd in a recording, and what to do about it; both in plain words.
struct Finding {
  Severity severity;
  std::string text;
  std::string advice;
};

using Findings = std::vector<Finding>;

}  // namespace scan_image_slam
