#include "scan_image_slam/ros/picture_size.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace scan_image_slam {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::array<std::uint8_t, 8> kPngSignature = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
constexpr std::array<std::uint8_t, 2> kJpegSignature = {0xFF, 0xD8};

template <std::size_t kSize>
bool BeginsWith(const Bytes& bytes, const std::array<std::uint8_t, kSize>& signature) {
  return bytes.size() >= kSize && std::equal(signature.begin(), signature.end(), bytes.begin());
}

/// Most significant byte first; 0 beyond the end.
std::uint32_t NumberAt(const Bytes& bytes, std::size_t at, std::size_t size) {
  std::uint32_t number = 0;
  for (std::size_t i = at; i < at + size; ++i)
    number = number << 8 | (i < bytes.size() ? bytes[i] : 0);
  return number;
}

int Limited(std::uint32_t side) { return static_cast<int>(std::min(side, 0x7FFFFFFFU)); }

cv::Size SizeOfPng(const Bytes& png) {
  constexpr std::size_t kWidth = 16;  // length and name of the first chunk stand before it
  return {Limited(NumberAt(png, kWidth, 4)), Limited(NumberAt(png, kWidth + 4, 4))};
}

bool BeginsFrame(std::uint8_t marker) {
  return marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
}

/// Markers that no length follows: TEM, RST0 to RST7, SOI, EOI.
bool StandsAlone(std::uint8_t marker) {
  return marker == 0x01 || (marker >= 0xD0 && marker <= 0xD9);
}

cv::Size SizeOfJpeg(const Bytes& jpeg) {
  std::size_t at = kJpegSignature.size();
  while (at + 1 < jpeg.size()) {
    const std::uint8_t marker = jpeg[at + 1];
    if (jpeg[at] != 0xFF || marker == 0x00 || marker == 0xFF) {
      ++at;                            // fill bytes
    } else if (BeginsFrame(marker)) {  // length, bits, height, width
      return {Limited(NumberAt(jpeg, at + 7, 2)), Limited(NumberAt(jpeg, at + 5, 2))};
    } else {
      at += 2 + (StandsAlone(marker) ? 0 : NumberAt(jpeg, at + 2, 2));
    }
  }
  return {};
}

}  // namespace

cv::Size DeclaredSize(const std::vector<std::uint8_t>& picture) {
  if (BeginsWith(picture, kPngSignature)) return SizeOfPng(picture);
  return BeginsWith(picture, kJpegSignature) ? SizeOfJpeg(picture) : cv::Size();
}

}  // namespace scan_image_slam
