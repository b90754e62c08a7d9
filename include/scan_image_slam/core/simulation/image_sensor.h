#pragma once

#include "scan_image_slam/core/simulation/camera_options.h"
#include "scan_image_slam/core/simulation/random_stream.h"

#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

namespace scan_image_slam {

/// How an image is developed from the light that fell on the sensor.
struct Development {
  double brightening = 1.0;  ///< factor on the pixels, at least 1
  double gain = 1.0;         ///< of the amplifier: it raises the noise
  double blur = 0.0;         ///< defocus, standard deviation [px]
};

/// Blur, vignetting, noise, colour filter and saturation of a camera.
class ImageSensor {
 public:
  ImageSensor(const CameraSimulatorOptions& options, std::uint64_t seed);

  /// `light` as rendered, CV_8UC1 or CV_8UC4, of the camera's size; returns an image in the
  /// encoding of the options. Its memory is new.
  cv::Mat Develop(const cv::Mat& light, const Development& development);

 private:
  void FillTable(double gain);
  void AddNoise(cv::Mat& image, const Development& development);

  CameraSimulatorOptions options_;
  RandomStream random_;
  std::vector<std::uint8_t> noise_;        // normal, 128 is zero, 32 a standard deviation
  std::vector<std::uint16_t> vignetting_;  // factor per pixel, in 1/256
  double table_gain_ = -1.0;
  std::vector<std::uint8_t> table_;  // by grey level and noise: what comes out at this gain
};

}  // namespace scan_image_slam
