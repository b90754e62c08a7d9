#pragma once

#include "scan_image_slam/core/pipeline/slam_pipeline.h"

#include <optional>
#include <string>
#include <utility>

#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>

namespace scan_image_slam {

/// What the fusion saw while a bag was played, for people to look at.
class FusionPictures {
 public:
  struct Options {
    int every = 0;      ///< so many images one as fusion_000001.png, by its number; 0: none
    std::string video;  ///< path of a film of all, AVI with JPEG pictures; empty: none
  };
  FusionPictures(std::string folder, Options options)
      : folder_(std::move(folder)), options_(std::move(options)) {}

  /// Throws std::runtime_error with the path if a file can't be written.
  void Add(const ScanImageFusion& fusion, const PipelineResult& result);

 private:
  void AddToVideo(Stamp stamp, const cv::Mat& picture);

  std::string folder_;
  Options options_;
  int fused_ = 0;
  cv::VideoWriter video_;
  cv::Mat first_picture_;  ///< waits for the second, which tells the rate
  std::optional<Stamp> first_stamp_;
};

}  // namespace scan_image_slam
