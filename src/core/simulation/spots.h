#pragma once

#include "scan_image_slam/core/simulation/scene_view.h"

#include <vector>

namespace scan_image_slam {

/// Mirror images of lamps on a wall (they move as the camera moves) and the shadow that the robot
/// casts on it. Whether something stands between is not looked at; lamps reach a few metres only.
std::vector<Spot> SpotsOn(const Wall& wall, const Lighting& lighting, const SceneView& view);

}  // namespace scan_image_slam
