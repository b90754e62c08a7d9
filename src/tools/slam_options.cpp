#include "slam_options.h"

#include "scan_image_slam/core/config/config_file.h"
#include "scan_image_slam/ros/package_files.h"

namespace scan_image_slam {

SlamOptions ReadSlamOptions(const std::string& config, const std::vector<std::string>& settings) {
  SlamOptions options;
  std::vector<ParameterSet> sets = options.Parameters();
  const bool by_name = config == "default" || config == "paper";
  const std::string path = by_name ? PackageFile("config/" + config + ".yaml") : config;
  ApplyConfig(ReadConfigFile(path), path, &sets);
  for (const std::string& setting : settings) {
    const std::size_t slash = setting.find('/');
    const std::size_t equals = setting.find('=');
    if (slash == std::string::npos || equals == std::string::npos || slash > equals) {
      throw ParameterError("--set " + setting + ": NODE/PARAMETER=VALUE is expected");
    }
    ApplyConfig({{setting.substr(0, slash),
                  {{setting.substr(slash + 1, equals - slash - 1),
                    ParseParameterValue(setting.substr(equals + 1))}}}},
                "--set", &sets);
  }
  return options;
}

}  // namespace scan_image_slam
