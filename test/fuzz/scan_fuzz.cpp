// Any scans, through all stages: they are refused, or every pose is finite.

#include "fuzz_input.h"
#include "scan_image_slam/core/pipeline/slam_pipeline.h"
#include "scan_image_slam/ros/sensor_conversions.h"

#include <cmath>
#include <stdexcept>

namespace scan_image_slam {
namespace {

sensor_msgs::LaserScan TakeScan(FuzzInput* input) {
  sensor_msgs::LaserScan scan;
  scan.header.stamp = input->TakeTime();
  input->Fill(&scan.angle_min, &scan.angle_max, &scan.angle_increment, &scan.time_increment,
              &scan.scan_time, &scan.range_min, &scan.range_max);
  scan.ranges = input->TakeVector<float>();
  return scan;
}

void Expect(const PipelineResult& result) {
  const Pose2& pose = result.pose.map_from_base;
  Require(IsFinite(pose));
}

}  // namespace
}  // namespace scan_image_slam

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace scan_image_slam;
  FuzzInput input(data, size);
  SlamPipeline pipeline(SlamOptions(), Expect);
  for (int i = 0; i < 4 && !input.empty(); ++i) {
    try {
      const LaserScan scan = ToLaserScan(TakeScan(&input));
      pipeline.AddScan(scan, scan.stamp);
    } catch (const std::invalid_argument&) {
    }
  }
  pipeline.Finish();
  return 0;
}
