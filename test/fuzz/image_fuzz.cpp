// Any image and any calibration: they are refused, or make a grey picture and a camera.

#include "fuzz_input.h"
#include "scan_image_slam/core/sensor/camera_model.h"
#include "scan_image_slam/ros/image_conversion.h"
#include "scan_image_slam/ros/sensor_conversions.h"

#include <array>
#include <stdexcept>

namespace scan_image_slam {
namespace {

const std::array<const char*, 16> kEncodings = {
    "mono8", "mono16", "bgr8",  "rgba8", "bayer_rggb8", "bayer_gbrg16", "yuv422", "yuv422_yuy2",
    "8UC1",  "16UC1",  "32FC1", "64FC3", "bayer_grbg8", "8UC3",         "16UC10", "nonsense"};

sensor_msgs::Image TakeImage(FuzzInput* input) {
  sensor_msgs::Image image;
  const auto encoding = input->Take<std::uint8_t>();
  image.encoding = encoding < kEncodings.size() ? kEncodings.at(encoding) : input->TakeText();
  input->Fill(&image.width, &image.height, &image.step, &image.is_bigendian);
  image.data = input->TakeVector<std::uint8_t>();
  return image;
}

sensor_msgs::CameraInfo TakeCalibration(FuzzInput* input) {
  sensor_msgs::CameraInfo info;
  info.distortion_model = input->Take<bool>() ? "plumb_bob" : input->TakeText();
  input->Fill(&info.width, &info.height, &info.binning_x, &info.binning_y, &info.roi.x_offset,
              &info.roi.y_offset, &info.roi.width, &info.roi.height);
  for (double& value : info.K) value = input->Take<double>();
  info.D = input->TakeVector<double>();
  return info;
}

}  // namespace
}  // namespace scan_image_slam

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace scan_image_slam;
  FuzzInput input(data, size);
  try {
    const sensor_msgs::Image image = TakeImage(&input);
    const cv::Mat grey = ToGrey(image);
    Require(grey.type() == CV_8U && grey.rows == static_cast<int>(image.height) &&
            grey.cols == static_cast<int>(image.width));
  } catch (const std::invalid_argument&) {
  }
  try {
    const CameraModel camera(ToCameraIntrinsics(TakeCalibration(&input)));
  } catch (const std::invalid_argument&) {
  }
  return 0;
}
