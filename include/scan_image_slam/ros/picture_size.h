#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

namespace scan_image_slam {

/// The size that a JPEG or PNG says it has, looked up without unpacking it: a few bytes can claim
/// any size. 0 x 0 if it is neither, or ends before it says so.
cv::Size DeclaredSize(const std::vector<std::uint8_t>& picture);

}  // namespace scan_image_slam
