#pragma once

#include "scan_image_slam/core/simulation/world.h"

#include <algorithm>
#include <cstdint>

#include <opencv2/core/fast_math.hpp>

namespace scan_image_slam {

/// Arithmetic on pixels of the renderer: grey (uint8_t), or blue, green and red in the three low
/// bytes of a uint32_t. Weights and factors are in 1/256, from 0 to 256.
template <typename Pixel>
struct PixelOps;

inline std::uint32_t ToByte(double value) {
  return static_cast<std::uint32_t>(cvRound(std::clamp(value, 0.0, 255.0)));
}

template <>
struct PixelOps<std::uint8_t> {
  using Pixel = std::uint8_t;
  static Pixel Make(const Colour& c, double light) {
    return static_cast<Pixel>(ToByte(light * (0.299 * c.red + 0.587 * c.green + 0.114 * c.blue)));
  }
  static Pixel Scale(Pixel p, std::uint32_t factor) { return static_cast<Pixel>(p * factor >> 8); }
  /// The same for factors above 256.
  static Pixel ScaleSaturated(Pixel p, std::uint32_t factor) {
    return static_cast<Pixel>(std::min<std::uint32_t>(p * factor >> 8, 255));
  }
  /// (256 - weight) parts of a and weight parts of b.
  static Pixel Blend(Pixel a, Pixel b, std::uint32_t weight) {
    return static_cast<Pixel>((a * (256 - weight) + b * weight + 128) >> 8);
  }
  /// Mean of columns[i][v] with weights that add up to 256.
  static Pixel Sum(const Pixel* const* columns, const std::uint32_t* weights, int count, int v) {
    std::uint32_t sum = 0;
    for (int i = 0; i < count; ++i) sum += columns[i][v] * weights[i];
    return static_cast<Pixel>(sum >> 8);
  }
};

template <>
struct PixelOps<std::uint32_t> {
  using Pixel = std::uint32_t;
  static constexpr Pixel kRedBlue = 0x00ff00ff;
  static constexpr Pixel kGreen = 0x0000ff00;
  static Pixel Make(const Colour& c, double light) {
    return ToByte(light * c.blue) | ToByte(light * c.green) << 8 | ToByte(light * c.red) << 16;
  }
  static Pixel Scale(Pixel p, std::uint32_t factor) {
    return ((p & kRedBlue) * factor >> 8 & kRedBlue) | ((p & kGreen) * factor >> 8 & kGreen);
  }
  static Pixel ScaleSaturated(Pixel p, std::uint32_t factor) {
    const auto channel = [&](int shift) {
      return std::min<std::uint32_t>((p >> shift & 255) * factor >> 8, 255) << shift;
    };
    return channel(0) | channel(8) | channel(16);
  }
  static Pixel Blend(Pixel a, Pixel b, std::uint32_t weight) {
    const std::uint32_t other = 256 - weight;
    const Pixel red_blue =
        ((a & kRedBlue) * other + (b & kRedBlue) * weight + 0x00800080) >> 8 & kRedBlue;
    const Pixel green = ((a & kGreen) * other + (b & kGreen) * weight + 0x8000) >> 8 & kGreen;
    return red_blue | green;
  }
  static Pixel Sum(const Pixel* const* columns, const std::uint32_t* weights, int count, int v) {
    std::uint32_t red_blue = 0;
    std::uint32_t green = 0;
    for (int i = 0; i < count; ++i) {
      red_blue += (columns[i][v] & kRedBlue) * weights[i];
      green += (columns[i][v] & kGreen) * weights[i];
    }
    return (red_blue >> 8 & kRedBlue) | (green >> 8 & kGreen);
  }
};

}  // namespace scan_image_slam
