// Any world and any configuration: read, or refused with a message.

#include "fuzz_file.h"
#include "scan_image_slam/core/config/config_file.h"
#include "scan_image_slam/core/config/slam_parameters.h"
#include "scan_image_slam/core/config/yaml_section.h"
#include "scan_image_slam/core/simulation/scenario.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace scan_image_slam;
  const FuzzFile file(data, size);
  try {
    LoadScenario(file.path());
  } catch (const YamlError&) {
  }
  try {
    SlamOptions options;
    std::vector<ParameterSet> sets = options.Parameters();
    ApplyConfig(ReadConfigFile(file.path()), file.path(), &sets);
  } catch (const ParameterError&) {
  }
  return 0;
}
