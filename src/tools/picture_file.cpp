#include "picture_file.h"

#include <stdexcept>

#include <opencv2/imgcodecs.hpp>

namespace scan_image_slam {

void WritePicture(const std::string& path, const cv::Mat& picture) {
  bool written = false;
  try {
    written = cv::imwrite(path, picture);
  } catch (const cv::Exception&) {  // an ending that OpenCV does not know
  }
  if (!written) throw std::runtime_error("can't write the picture " + path);
}

}  // namespace scan_image_slam
