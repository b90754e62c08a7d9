#pragma once

#include "scan_image_slam/core/config/slam_parameters.h"

#include <string>
#include <vector>

namespace scan_image_slam {

/// Options of a configuration: `default`, `paper`, or a yaml file; then `settings`, each
/// NODE/PARAMETER=VALUE, over it. Throws ParameterError for what can't be used.
SlamOptions ReadSlamOptions(const std::string& config, const std::vector<std::string>& settings);

}  // namespace scan_image_slam
