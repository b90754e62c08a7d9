// Any models and matches, as another node may send them: they are refused, or matched and mapped to
// finite poses.

#include "fuzz_input.h"
#include "scan_image_slam/core/mapping/mapper.h"
#include "scan_image_slam/core/matching/bounded_icp.h"
#include "scan_image_slam/ros/slam_messages.h"

#include <stdexcept>

namespace scan_image_slam {
namespace {

IcpModel TakeModel(FuzzInput* input) {
  IcpModel model;
  model.header.stamp = input->TakeTime();
  input->Fill(&model.laser_x, &model.laser_y, &model.laser_yaw, &model.upside_down,
              &model.sweep_velocity_x, &model.sweep_velocity_y, &model.sweep_velocity_yaw,
              &model.has_image);
  model.ranges = input->TakeVector<float>();
  // Mostly as long as the others.
  const std::size_t n = input->Take<std::uint8_t>() == 255 ? 1 : model.ranges.size();
  for (auto* values : {&model.bearings, &model.time_offsets, &model.points_x, &model.points_y,
                       &model.edge_weights}) {
    values->resize(n);
    for (float& value : *values) value = input->Take<float>();
  }
  model.edge_signs.resize(n);
  model.edges.resize(input->Take<std::uint8_t>() % 8);
  for (VerticalEdge& edge : model.edges) {
    input->Fill(&edge.camera_x, &edge.camera_y, &edge.bearing, &edge.bearing_stddev, &edge.range,
                &edge.range_stddev, &edge.range_by_bearing, &edge.time_offset, &edge.sign,
                &edge.weight, &edge.contrast);
  }
  return model;
}

void Map(const FusedModel& model, const MatchedMotion& match, Mapper* mapper) {
  Require(IsFinite(mapper->AddMatch(match).map_from_base));
  mapper->AddModel(model, match);
}

}  // namespace
}  // namespace scan_image_slam

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace scan_image_slam;
  FuzzInput input(data, size);
  BoundedIcp bounded_icp{BoundedIcpOptions()};
  Mapper mapper{MapperOptions()};
  for (int i = 0; i < 4 && !input.empty(); ++i) {
    try {
      const FusedModel model = FromMessage(TakeModel(&input));
      // What was made here travels to the mapper as a message, too.
      Map(model, FromMessage(ToMessage(bounded_icp.Match(model), "base_link")), &mapper);
    } catch (const std::invalid_argument&) {
    }
  }
  return 0;
}
