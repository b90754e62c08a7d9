// Any transforms: refused, or the sensor has a place that is finite.

#include "fuzz_input.h"
#include "scan_image_slam/ros/sensor_frames.h"

#include <array>

#include <geometry_msgs/TransformStamped.h>
#include <tf2/exceptions.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace scan_image_slam;
  constexpr std::array<const char*, 4> kFrames = {"base_link", "mast", "/laser", ""};
  FuzzInput input(data, size);
  tf2::BufferCore tf;
  while (!input.empty()) {
    geometry_msgs::TransformStamped transform;
    transform.header.stamp = input.TakeTime();
    transform.header.frame_id = kFrames[input.Take<std::uint8_t>() % kFrames.size()];
    transform.child_frame_id = kFrames[input.Take<std::uint8_t>() % kFrames.size()];
    auto& t = transform.transform.translation;
    auto& r = transform.transform.rotation;
    input.Fill(&t.x, &t.y, &t.z, &r.x, &r.y, &r.z, &r.w);
    try {
      tf.setTransform(transform, "fuzz", input.Take<bool>());
    } catch (const tf2::TransformException&) {
    }
    const FrameLookup lookup = LookUpSensor(tf, "base_link", "laser");
    Require(lookup.found == lookup.problem.empty());
    Require(lookup.base_from_sensor.matrix().allFinite());
  }
  return 0;
}
