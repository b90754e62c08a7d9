#pragma once

#include "pixel_ops.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <opencv2/core/fast_math.hpp>

namespace scan_image_slam {

/// A texture at all halved widths and heights, each independent of the other, for area filtering.
/// Columns (equal u) are contiguous in v. Width and height are powers of two.
template <typename Pixel>
class Ripmap {
 public:
  /// `texels` column by column.
  Ripmap(int width, int height, std::vector<Pixel> texels)
      : u_levels_(LevelsOf(width)), v_levels_(LevelsOf(height)) {
    levels_.resize(static_cast<std::size_t>(u_levels_) * v_levels_);
    levels_[0] = {width, height, std::move(texels)};
    for (int lu = 0; lu < u_levels_; ++lu) {
      if (lu > 0) levels_[Index(lu, 0)] = HalveWidth(levels_[Index(lu - 1, 0)]);
      for (int lv = 1; lv < v_levels_; ++lv) {
        levels_[Index(lu, lv)] = HalveHeight(levels_[Index(lu, lv - 1)]);
      }
    }
  }

  /// One size of the texture; texel (u, v) is at texels[u * height + v].
  struct Level {
    int width = 0;
    int height = 0;
    std::vector<Pixel> texels;
    const Pixel* Column(int u) const {
      return texels.data() + static_cast<std::size_t>(u) * height;
    }
  };

  /// Halved `lu` and `lv` times; clamped to what exists.
  const Level& At(int lu, int lv) const {
    return levels_[Index(std::clamp(lu, 0, u_levels_ - 1), std::clamp(lv, 0, v_levels_ - 1))];
  }

 private:
  static int LevelsOf(int size) {
    int levels = 1;
    while (size > 1) {
      size /= 2;
      ++levels;
    }
    return levels;
  }

  std::size_t Index(int lu, int lv) const { return static_cast<std::size_t>(lu) * v_levels_ + lv; }

  static Level HalveWidth(const Level& fine) {
    Level level{fine.width / 2, fine.height, {}};
    level.texels.resize(static_cast<std::size_t>(level.width) * level.height);
    for (int u = 0; u < level.width; ++u) {
      for (int v = 0; v < level.height; ++v) {
        level.texels[static_cast<std::size_t>(u) * level.height + v] =
            PixelOps<Pixel>::Blend(fine.Column(2 * u)[v], fine.Column(2 * u + 1)[v], 128);
      }
    }
    return level;
  }

  static Level HalveHeight(const Level& fine) {
    Level level{fine.width, fine.height / 2, {}};
    level.texels.resize(static_cast<std::size_t>(level.width) * level.height);
    for (std::size_t i = 0; i < level.texels.size(); ++i) {
      level.texels[i] = PixelOps<Pixel>::Blend(fine.texels[2 * i], fine.texels[2 * i + 1], 128);
    }
    return level;
  }

  int u_levels_;
  int v_levels_;
  std::vector<Level> levels_;
};

/// How often a texture has to be halved so that a texel is about as long as `footprint`, both in
/// the same unit.
inline int LevelFor(double footprint, double texel) {
  if (footprint <= texel) return 0;
  return cvRound(std::log2(footprint / texel));
}

}  // namespace scan_image_slam
