#pragma once

#include <memory>

#include <opencv2/core.hpp>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>

namespace scan_image_slam {

/// A message's pointer as the core's types hold it.
template <typename BoostPointer>
std::shared_ptr<const void> ToStdPointer(const BoostPointer& message) {
  return {message.get(), [message](const void*) {}};
}

/// Grey picture of any encoding that cv_bridge knows, CV_8U. A mono8 picture is not copied: the
/// result shares the message's memory, which must outlive it. Throws std::invalid_argument, saying
/// what is wrong, if the message can't be used.
cv::Mat ToGrey(const sensor_msgs::Image& message);

/// The same for JPEG and PNG.
cv::Mat ToGrey(const sensor_msgs::CompressedImage& message);

/// True if a grey picture shows the pattern of a Bayer mosaic: some drivers label raw Bayer data as
/// mono8.
bool LooksLikeBayer(const cv::Mat& grey);

/// Takes the pattern of a Bayer mosaic out of a picture, without shifting it.
cv::Mat SmoothBayer(const cv::Mat& grey);

}  // namespace scan_image_slam
