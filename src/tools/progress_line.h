#pragma once

#include <string>

namespace scan_image_slam {

/// Progress of long work on standard error: one line that renews itself on a terminal, nothing
/// elsewhere but every tenth of the work.
class ProgressLine {
 public:
  explicit ProgressLine(std::string name);
  /// `share` of the work that is done, 0 to 1.
  void Show(double share);
  void Finish() const;

 private:
  std::string name_;
  bool terminal_;
  int shown_percent_ = -1;
};

}  // namespace scan_image_slam
