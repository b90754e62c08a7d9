// Any match and any pose: refused, or the mapper's pose is finite.

#include "fuzz_input.h"
#include "scan_image_slam/core/mapping/mapper.h"
#include "scan_image_slam/ros/sensor_conversions.h"
#include "scan_image_slam/ros/slam_messages.h"

#include <stdexcept>

namespace scan_image_slam {
namespace {

geometry_msgs::Pose2D TakePose2D(FuzzInput* input) {
  geometry_msgs::Pose2D pose;
  input->Fill(&pose.x, &pose.y, &pose.theta);
  return pose;
}

ScanMatch TakeMatch(FuzzInput* input) {
  ScanMatch match;
  match.header.stamp = input->TakeTime();
  match.start_stamp = input->TakeTime();
  match.reference_stamp = input->TakeTime();
  match.reference_pose = TakePose2D(input);
  match.motion = TakePose2D(input);
  match.has_odometry = input->Take<bool>();
  match.odom_pose = TakePose2D(input);
  input->Fill(&match.mode, &match.status, &match.candidates, &match.points, &match.matched,
              &match.window_distance, &match.deviation_distance, &match.degenerate_direction,
              &match.sweep_correction_x, &match.edge_correction_yaw);
  for (double& value : match.covariance) value = input->Take<double>();
  return match;
}

geometry_msgs::Pose TakePose(FuzzInput* input) {
  geometry_msgs::Pose pose;
  input->Fill(&pose.position.x, &pose.position.y, &pose.orientation.x, &pose.orientation.y,
              &pose.orientation.z, &pose.orientation.w);
  return pose;
}

}  // namespace
}  // namespace scan_image_slam

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace scan_image_slam;
  FuzzInput input(data, size);
  Mapper mapper{MapperOptions()};
  while (!input.empty()) {
    try {
      if (input.Take<std::uint8_t>() % 4 == 0) {
        mapper.SetPose(ToPose2(TakePose(&input)));
      } else {
        Require(IsFinite(mapper.AddMatch(FromMessage(TakeMatch(&input))).map_from_base));
      }
    } catch (const std::invalid_argument&) {
    }
  }
  return 0;
}
