#pragma once

#include "ripmap.h"
#include "scan_image_slam/core/simulation/world.h"

#include <opencv2/core.hpp>

namespace scan_image_slam {

/// Length of a texel of a material, and of the tile that repeats [m].
constexpr double kMaterialTexel = 0.004;
constexpr int kMaterialSize = 512;  // texels

/// Factor on the colour, in 1/256, as a tile that fits to itself; u along, v up.
Ripmap<std::uint8_t> MakeMaterial(Material material);

/// Texels of a picture along and up, however large it is.
constexpr int kPictureSize = 256;

/// The picture as seen (first row at the top), CV_8UC3 blue, green, red.
cv::Mat DrawPicture(const PictureSpec& spec);

/// The same for the renderer.
template <typename Pixel>
Ripmap<Pixel> MakePicture(const PictureSpec& spec) {
  const cv::Mat image = DrawPicture(spec);
  std::vector<Pixel> texels;
  texels.reserve(image.total());
  for (int u = 0; u < image.cols; ++u) {
    for (int v = image.rows - 1; v >= 0; --v) {
      const auto& p = image.at<cv::Vec3b>(v, u);
      texels.push_back(PixelOps<Pixel>::Make({1.0 * p[2], 1.0 * p[1], 1.0 * p[0]}, 1.0));
    }
  }
  return Ripmap<Pixel>(image.cols, image.rows, std::move(texels));
}

}  // namespace scan_image_slam
