#pragma once

#include "scan_image_slam/core/recording/finding.h"

#include <string>

namespace scan_image_slam {

/// The only finding that tells `words`; a failure text if there is none or more than one.
inline Finding FindingWith(const Findings& findings, const std::string& words) {
  Finding found{Severity::kNote, "none tells " + words, ""};
  int count = 0;
  for (const Finding& finding : findings) {
    if (finding.text.find(words) == std::string::npos) continue;
    found = finding;
    ++count;
  }
  if (count > 1) found.text = "more than one tells " + words;
  return found;
}

inline bool Tells(const Findings& findings, const std::string& words) {
  for (const Finding& finding : findings) {
    if (finding.text.find(words) != std::string::npos) return true;
  }
  return false;
}

}  // namespace scan_image_slam
