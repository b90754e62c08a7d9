#pragma once

#include "scan_image_slam/core/config/parameter_set.h"

#include <string>
#include <vector>

namespace scan_image_slam {

/// The parameters as a page of Markdown, a table for each node, and what those of other packages
/// are called here.
std::string WriteReference(const std::vector<ParameterSet>& sets);

}  // namespace scan_image_slam
