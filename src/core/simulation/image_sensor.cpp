#include "scan_image_slam/core/simulation/image_sensor.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace scan_image_slam {
namespace {

constexpr std::uint32_t kNoiseSize = 1 << 18;
constexpr double kNoiseUnit = 32.0;    // of the noise, per standard deviation
constexpr double kSmallestBlur = 0.2;  // narrower ones change nothing [px]

/// What a sensor behind red, green, green and blue filters measures.
cv::Mat ToBayer(const cv::Mat& bgr) {
  cv::Mat bayer(bgr.size(), CV_8UC1);
  for (int v = 0; v < bgr.rows; ++v) {
    const auto* from = bgr.ptr<cv::Vec3b>(v);
    auto* to = bayer.ptr<std::uint8_t>(v);
    for (int u = 0; u < bgr.cols; ++u) to[u] = from[u][2 - (u % 2 + v % 2)];
  }
  return bayer;
}

void Blur(cv::Mat& image, double sigma) {
  if (sigma < kSmallestBlur) return;
  const int half = std::max(1, static_cast<int>(std::ceil(2.2 * sigma)));
  cv::GaussianBlur(image, image, {2 * half + 1, 2 * half + 1}, sigma, sigma, cv::BORDER_REPLICATE);
}

}  // namespace

ImageSensor::ImageSensor(const CameraSimulatorOptions& options, std::uint64_t seed)
    : options_(options), random_(seed, "camera noise") {
  RandomStream table(seed, "camera noise table");
  noise_.resize(kNoiseSize + 3 * static_cast<std::size_t>(options.width));
  for (std::uint8_t& value : noise_) {
    value = static_cast<std::uint8_t>(
        std::clamp(std::round(128.0 + kNoiseUnit * table.Normal()), 0.0, 255.0));
  }
  const double cx = 0.5 * options.width;
  const double cy = 0.5 * options.height;
  for (int v = 0; v < options.height; ++v) {
    for (int u = 0; u < options.width; ++u) {
      const double r2 = ((u - cx) * (u - cx) + (v - cy) * (v - cy)) / (cx * cx + cy * cy);
      vignetting_.push_back(
          static_cast<std::uint16_t>(std::lround(256.0 * (1.0 - options.vignetting * r2))));
    }
  }
}

cv::Mat ImageSensor::Develop(const cv::Mat& light, const Development& development) {
  cv::Mat image;
  if (light.channels() == 4) {
    cv::cvtColor(light, image, cv::COLOR_BGRA2BGR);
  } else {
    image = light.clone();
  }
  Blur(image, development.blur);
  if (options_.encoding == ImageEncoding::kBayerRggb8) image = ToBayer(image);
  AddNoise(image, development);
  return image;
}

void ImageSensor::FillTable(double gain) {
  if (table_gain_ == gain) return;
  table_gain_ = gain;
  table_.resize(std::size_t{256} * 256);
  const double read = options_.read_noise * gain;
  for (int level = 0; level < 256; ++level) {
    const double stddev = std::sqrt(read * read + options_.shot_noise * gain * level);
    for (int n = 0; n < 256; ++n) {
      const double value = level + stddev * (n - 128) / kNoiseUnit;
      table_[level * 256 + n] = static_cast<std::uint8_t>(std::clamp(value + 0.5, 0.0, 255.0));
    }
  }
}

void ImageSensor::AddNoise(cv::Mat& image, const Development& development) {
  FillTable(development.gain);
  const auto brightening = static_cast<std::uint32_t>(std::lround(256.0 * development.brightening));
  const int channels = image.channels();
  for (int v = 0; v < image.rows; ++v) {
    auto* pixels = image.ptr<std::uint8_t>(v);
    const std::uint8_t* noise = noise_.data() + random_.Index(kNoiseSize);
    const std::uint16_t* vignetting = vignetting_.data() + static_cast<std::size_t>(v) * image.cols;
    for (int u = 0; u < image.cols; ++u) {
      const std::uint32_t factor = vignetting[u] * brightening >> 8;
      for (int i = u * channels; i < (u + 1) * channels; ++i) {
        const std::uint32_t level = std::min<std::uint32_t>((pixels[i] * factor + 128) >> 8, 255);
        pixels[i] = table_[level << 8 | noise[i]];
      }
    }
  }
}

}  // namespace scan_image_slam
