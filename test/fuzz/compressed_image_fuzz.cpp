// Any compressed image: refused, or a grey picture of the size that it says it has.

#include "fuzz_input.h"
#include "scan_image_slam/ros/image_conversion.h"
#include "scan_image_slam/ros/picture_size.h"

#include <stdexcept>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace scan_image_slam;
  sensor_msgs::CompressedImage image;
  image.data.assign(data, data + size);
  try {
    const cv::Mat grey = ToGrey(image);
    const cv::Size declared = DeclaredSize(image.data);
    // Turned by a quarter if its EXIF data say so.
    Require(grey.type() == CV_8U && grey.total() == static_cast<std::size_t>(declared.area()));
  } catch (const std::invalid_argument&) {
  }
  return 0;
}
