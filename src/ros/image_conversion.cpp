#include "scan_image_slam/ros/image_conversion.h"

#include "scan_image_slam/ros/picture_size.h"

#include <cstdlib>
#include <stdexcept>
#include <string>

#include <cv_bridge/cv_bridge.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <sensor_msgs/image_encodings.h>

namespace scan_image_slam {
namespace {

constexpr std::uint64_t kMaxPixels = 1 << 26;

void CheckSize(std::uint64_t width, std::uint64_t height) {
  if (width == 0 || height == 0 || width > kMaxPixels || height > kMaxPixels / width) {
    throw std::invalid_argument("image size " + std::to_string(width) + " x " +
                                std::to_string(height));
  }
}

void CheckLayout(const sensor_msgs::Image& message) {
  CheckSize(message.width, message.height);
  const std::size_t bits =
      static_cast<std::size_t>(sensor_msgs::image_encodings::bitDepth(message.encoding)) *
      static_cast<std::size_t>(sensor_msgs::image_encodings::numChannels(message.encoding));
  if (message.step < message.width * bits / 8 ||
      message.data.size() < static_cast<std::size_t>(message.step) * message.height) {
    throw std::invalid_argument("the image's data (" + std::to_string(message.data.size()) +
                                " bytes) is shorter than its size and encoding '" +
                                message.encoding + "' say");
  }
}

cv::Mat WithoutMosaic(const cv::Mat& grey) {
  return LooksLikeBayer(grey) ? SmoothBayer(grey) : grey;
}

}  // namespace

cv::Mat ToGrey(const sensor_msgs::Image& message) {
  namespace enc = sensor_msgs::image_encodings;
  try {
    CheckLayout(message);
    if (message.encoding == enc::MONO8 || message.encoding == enc::TYPE_8UC1) {
      // const_cast: cv::Mat has no read-only view; nobody writes to it.
      const cv::Mat view(static_cast<int>(message.height), static_cast<int>(message.width), CV_8U,
                         const_cast<std::uint8_t*>(message.data.data()), message.step);
      return WithoutMosaic(view);
    }
    if (message.encoding == enc::MONO16 || message.encoding == enc::TYPE_16UC1) {
      cv::Mat grey;
      cv_bridge::toCvCopy(message)->image.convertTo(grey, CV_8U, 1.0 / 256.0);
      return grey;
    }
    return cv_bridge::toCvCopy(message, enc::MONO8)->image;
  } catch (const cv_bridge::Exception& error) {
    throw std::invalid_argument("encoding '" + message.encoding + "': " + error.what());
  } catch (const cv::Exception& error) {
    throw std::invalid_argument("encoding '" + message.encoding + "': " + error.what());
  } catch (const std::runtime_error& error) {  // an encoding that sensor_msgs does not know
    throw std::invalid_argument("encoding '" + message.encoding + "': " + error.what());
  }
}

cv::Mat ToGrey(const sensor_msgs::CompressedImage& message) {
  if (message.data.empty()) throw std::invalid_argument("the compressed image is empty");
  const cv::Size size = DeclaredSize(message.data);
  if (size.empty()) {
    throw std::invalid_argument("format '" + message.format + "': the data is no JPEG or PNG");
  }
  CheckSize(static_cast<std::uint64_t>(size.width), static_cast<std::uint64_t>(size.height));
  cv::Mat grey;
  try {
    grey = cv::imdecode(message.data, cv::IMREAD_GRAYSCALE);
  } catch (const cv::Exception& error) {
    throw std::invalid_argument("format '" + message.format + "': " + error.what());
  }
  if (grey.empty()) {
    throw std::invalid_argument("format '" + message.format + "': the image can't be decoded");
  }
  return WithoutMosaic(grey);
}

bool LooksLikeBayer(const cv::Mat& grey) {
  // In a mosaic the next pixel but one has the same colour and the next one another.
  constexpr int kRowStep = 7;  // odd, so that both kinds of rows are looked at
  std::int64_t next = 0;
  std::int64_t next_but_one = 0;
  std::int64_t count = 0;
  for (int y = 0; y < grey.rows; y += kRowStep) {
    const auto* row = grey.ptr<std::uint8_t>(y);
    for (int x = 0; x + 2 < grey.cols; x += 3) {
      next += std::abs(row[x] - row[x + 1]);
      next_but_one += std::abs(row[x] - row[x + 2]);
      ++count;
    }
  }
  // Noise alone makes both alike; the pattern must stand out by two grey levels.
  return count > 0 && 2 * next > 3 * next_but_one && next - next_but_one > 2 * count;
}

cv::Mat SmoothBayer(const cv::Mat& grey) {
  cv::Mat smooth;
  const cv::Mat kernel = (cv::Mat_<float>(1, 3) << 0.25f, 0.5f, 0.25f);
  cv::sepFilter2D(grey, smooth, CV_8U, kernel, kernel);
  return smooth;
}

}  // namespace scan_image_slam
