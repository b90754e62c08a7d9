#pragma once

#include "scan_image_slam/core/config/yaml_section.h"
#include "scan_image_slam/core/simulation/wall_builder.h"
#include "scan_image_slam/core/simulation/world.h"

namespace scan_image_slam {

/// One item of `objects`: furniture, pillars, clutter. Throws YamlError.
void ReadObject(YamlSection& section, World& world);

/// One item of `decorations`: something painted on a named face. Throws YamlError.
void ReadDecoration(YamlSection& section, World& world, const NamedFaces& names);

}  // namespace scan_image_slam
