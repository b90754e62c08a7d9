#pragma once

#include <string>

#include <opencv2/core.hpp>

namespace scan_image_slam {

/// Writes a picture in the format of its ending (.png, .jpg, ...). Throws std::runtime_error with
/// the path if it can't be written or OpenCV does not know the ending.
void WritePicture(const std::string& path, const cv::Mat& picture);

}  // namespace scan_image_slam
