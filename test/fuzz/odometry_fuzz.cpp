// Any readings of the encoders: refused, or the poses between them are finite.

#include "fuzz_input.h"
#include "scan_image_slam/core/sensor/odometry_buffer.h"
#include "scan_image_slam/ros/sensor_conversions.h"

#include <stdexcept>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace scan_image_slam;
  FuzzInput input(data, size);
  OdometryBuffer odometry{OdometryOptions()};
  while (!input.empty()) {
    try {
      geometry_msgs::Pose pose;
      const Stamp stamp = ToStamp(input.TakeTime());
      input.Fill(&pose.position.x, &pose.position.y, &pose.position.z, &pose.orientation.x,
                 &pose.orientation.y, &pose.orientation.z, &pose.orientation.w);
      odometry.Add(stamp, ToPose2(pose));
      const auto between = odometry.ContinuousPose(ToStamp(input.TakeTime()));
      Require(!between || IsFinite(*between));
    } catch (const std::invalid_argument&) {
    }
  }
  return 0;
}
