#pragma once

#include "pixel_ops.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <opencv2/core/fast_math.hpp>

namespace scan_image_slam {

/// Rows of a column, as real numbers: 0 the border of the first one.
struct RowSpan {
  double low = 0.0;
  double high = 0.0;
  bool empty() const { return !(high > low); }
  RowSpan Clip(const RowSpan& other) const {
    return {std::max(low, other.low), std::min(high, other.high)};
  }
};

/// Paints the rows of a span with source(row). Rows at the ends that are covered in part, and all
/// rows if `coverage` (of the column's width) is below 1, are mixed with what is there.
template <typename Pixel, typename Source>
void FillSpan(Pixel* column, const RowSpan& span, double coverage, const Source& source) {
  if (span.empty() || coverage <= 0.0) return;
  const auto mix = [&](int row, double part) {
    const auto weight = static_cast<std::uint32_t>(cvRound(256.0 * part));
    column[row] = PixelOps<Pixel>::Blend(column[row], source(row), weight);
  };
  const int first = static_cast<int>(span.low);
  const int last = static_cast<int>(std::ceil(span.high)) - 1;
  if (first == last) {
    mix(first, (span.high - span.low) * coverage);
    return;
  }
  mix(first, (first + 1 - span.low) * coverage);
  if (coverage >= 1.0) {
    for (int row = first + 1; row < last; ++row) column[row] = source(row);
  } else {
    const auto weight = static_cast<std::uint32_t>(cvRound(256.0 * coverage));
    for (int row = first + 1; row < last; ++row) {
      column[row] = PixelOps<Pixel>::Blend(column[row], source(row), weight);
    }
  }
  mix(last, (span.high - last) * coverage);
}

/// A quantity that grows evenly from row to row, as a texel index with 16 bits of fraction. It
/// wraps around at 65536 texels, which textures (powers of two) do not notice.
class TexelRamp {
 public:
  /// `at_zero` in the middle of row 0, both in texels.
  TexelRamp(double at_zero, double per_row)
      : start_(
            static_cast<std::uint32_t>(static_cast<std::int64_t>(std::floor(at_zero * 65536.0)))),
        step_(static_cast<std::uint32_t>(static_cast<std::int64_t>(per_row * 65536.0))) {}
  std::uint32_t At(int row) const {
    return (start_ + step_ * static_cast<std::uint32_t>(row)) >> 16;
  }

 private:
  std::uint32_t start_;
  std::uint32_t step_;
};

/// A factor in 1/256, at most 256, that changes evenly from row to row.
class FactorRamp {
 public:
  FactorRamp(double at_zero, double per_row)
      : start_(static_cast<std::int64_t>(at_zero * 65536.0)),
        step_(static_cast<std::int64_t>(per_row * 65536.0)) {}
  std::uint32_t At(int row) const {
    const std::int64_t factor = (start_ + step_ * row + 32768) >> 16;
    return static_cast<std::uint32_t>(std::min<std::int64_t>(factor, 256));
  }

 private:
  std::int64_t start_;
  std::int64_t step_;
};

}  // namespace scan_image_slam
