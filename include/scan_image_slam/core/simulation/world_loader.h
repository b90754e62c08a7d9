#pragma once

#include "scan_image_slam/core/config/yaml_section.h"
#include "scan_image_slam/core/simulation/wall_builder.h"
#include "scan_image_slam/core/simulation/world.h"

namespace scan_image_slam {

/// Adds what the sections `ceiling_height`, `floor`, `ceiling`, `walls`, `objects`, `decorations`,
/// `people` and `lighting` of a world file describe; `names` collects the faces that decorations
/// (here or in a file that includes this one) can be put on. Throws YamlError.
void ReadWorld(YamlSection& root, World& world, NamedFaces& names);

}  // namespace scan_image_slam
