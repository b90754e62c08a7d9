#pragma once

namespace scan_image_slam {

/// The whole numbers begin <= i < end that one axis of a growing grid covers.
struct IndexRange {
  int begin = 0;
  int end = 0;

  int size() const { return end - begin; }
  bool Contains(int i) const { return begin <= i && i < end; }

  /// The smallest range that holds this one and `i`; where it must grow, it grows `margin` farther,
  /// so that a robot that drives on does not make it grow again with every step.
  IndexRange Including(int i, int margin) const {
    if (Contains(i)) return *this;
    if (size() == 0) return {i - margin, i + margin + 1};
    return i < begin ? IndexRange{i - margin, end} : IndexRange{begin, i + margin + 1};
  }
};

}  // namespace scan_image_slam
