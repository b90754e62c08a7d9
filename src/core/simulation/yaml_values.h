#pragma once

#include "scan_image_slam/core/config/yaml_section.h"
#include "scan_image_slam/core/simulation/world.h"

#include <string>
#include <vector>

namespace scan_image_slam {

/// Values that several parts of a world file share.

constexpr double kMaxHeight = 20.0;    // of anything [m]
constexpr double kMaxLength = 1000.0;  // of anything [m]

/// `key: [red, green, blue]`, 0..255.
Colour ReadColour(YamlSection& section, const std::string& key, const Colour& fallback);

/// `colour` and `material`.
Face ReadFace(YamlSection& section, const Face& fallback);

/// `laser: normal|dark|glass|invisible`.
LaserReturn ReadLaserReturn(YamlSection& section);

/// `repeat: {count: N, step: [dx, dy]}`: the offsets, the first is zero; only zero without it.
std::vector<Eigen::Vector2d> ReadRepeat(YamlSection& section);

}  // namespace scan_image_slam
