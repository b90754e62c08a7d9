#pragma once

#include "scan_image_slam/core/mapping/map_file.h"

#include <string>

namespace scan_image_slam {

/// Reads a map as map_server does, from its yaml and the picture that this names: cells are 100
/// (occupied), 0 (free) or -1 (unknown), by the thresholds of the file. Throws std::runtime_error,
/// which names the file and the key, for what is missing or wrong, for a map that is turned and for
/// the mode `raw`.
MapImage ReadMap(const std::string& yaml_file);

}  // namespace scan_image_slam
