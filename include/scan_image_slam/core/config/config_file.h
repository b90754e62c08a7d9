#pragma once

#include "scan_image_slam/core/config/parameter_set.h"

#include <map>
#include <string>
#include <vector>

namespace scan_image_slam {

/// A configuration file: for each node a section with its parameters; deeper levels are joined to
/// names with slashes. Throws ParameterError, naming the file and line, if it can't be read.
using ConfigSections = std::map<std::string, std::map<std::string, ParameterValue>>;
ConfigSections ReadConfigFile(const std::string& path);

/// Sets what the file says; sections that fit no set are an error.
void ApplyConfig(const ConfigSections& sections, const std::string& path,
                 std::vector<ParameterSet>* sets);

/// Reads a scalar as yaml 1.1 does, as far as rosparam tells them apart.
ParameterValue ParseParameterValue(const std::string& text);

/// The sets as a configuration file, each parameter with its unit, range and meaning.
std::string WriteConfig(const std::vector<ParameterSet>& sets);

}  // namespace scan_image_slam
