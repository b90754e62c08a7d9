#include "progress_line.h"

#include <iostream>
#include <utility>

#include <unistd.h>

namespace scan_image_slam {

ProgressLine::ProgressLine(std::string name)
    : name_(std::move(name)), terminal_(isatty(STDERR_FILENO) != 0) {}

void ProgressLine::Show(double share) {
  const int step = terminal_ ? 1 : 10;
  const int percent = static_cast<int>(share * 100.0) / step * step;
  if (percent <= shown_percent_) return;
  shown_percent_ = percent;
  std::cerr << (terminal_ ? "\r" : "") << name_ << ": " << percent << " %"
            << (terminal_ ? "" : "\n") << std::flush;
}

void ProgressLine::Finish() const {
  if (terminal_ && shown_percent_ >= 0) std::cerr << "\n";
}

}  // namespace scan_image_slam
