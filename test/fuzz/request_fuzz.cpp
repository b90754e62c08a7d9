// Any requests to change parameters or to write files: refused, or nothing gets out of bounds.

#include "fuzz_input.h"
#include "scan_image_slam/core/config/slam_parameters.h"
#include "scan_image_slam/ros/live_parameters.h"
#include "scan_image_slam/ros/map_files.h"

#include <stdexcept>
#include <variant>

namespace scan_image_slam {
namespace {

constexpr double kRounding = 1e-9;  // of degrees that are kept as radians

/// One of the set, so that requests get beyond their names, or any.
std::string TakeName(const ParameterSet& set, FuzzInput* input) {
  const auto number = input->Take<std::uint8_t>();
  return number < set.parameters().size() ? set.parameters()[number].name : input->TakeText();
}

dynamic_reconfigure::Config TakeConfig(const ParameterSet& set, FuzzInput* input) {
  dynamic_reconfigure::Config config;
  for (int i = 0; i < 4; ++i) {
    const std::string name = TakeName(set, input);
    switch (input->Take<std::uint8_t>() % 4) {
      case 0:
        config.bools.emplace_back().name = name;
        config.bools.back().value = input->Take<std::uint8_t>();
        break;
      case 1:
        config.ints.emplace_back().name = name;
        config.ints.back().value = input->Take<std::int32_t>();
        break;
      case 2:
        config.doubles.emplace_back().name = name;
        config.doubles.back().value = input->Take<double>();
        break;
      default:
        config.strs.emplace_back().name = name;
        config.strs.back().value = input->TakeText();
    }
  }
  return config;
}

void Change(const ParameterSet& set, FuzzInput* input) {
  try {
    set.Set(LiveParameters::Checked(TakeConfig(set, input), set));
  } catch (const ParameterError&) {
  }
  for (const Parameter& p : set.parameters()) {
    const ParameterValue value = p.get();
    if (const double* number = std::get_if<double>(&value)) {
      Require(*number >= p.range.min - kRounding && *number <= p.range.max + kRounding);
    }
  }
}

void Write(const std::string& name) {
  const std::string folder = "/nowhere/maps";
  try {
    const std::string path = PathInside(folder, name);
    Require(path.compare(0, folder.size() + 1, folder + "/") == 0);
    Require(("/" + path + "/").find("/../") == std::string::npos);
  } catch (const std::invalid_argument&) {
  }
}

}  // namespace
}  // namespace scan_image_slam

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace scan_image_slam;
  FuzzInput input(data, size);
  SlamOptions options;
  const auto sets = options.Parameters();
  while (!input.empty()) {
    Write(input.TakeText());
    for (const ParameterSet& set : sets) Change(set, &input);
  }
  return 0;
}
