#pragma once

#include "scan_image_slam/core/evaluation/map_quality.h"
#include "scan_image_slam/core/simulation/laser_options.h"
#include "scan_image_slam/core/simulation/world.h"

#include <vector>

namespace scan_image_slam {

/// What the simulated laser can see of the world without its people from these poses, as a
/// reference for maps. Walls: those that a beam has met within the laser's range. Seen points:
/// where a beam comes back from, that is not beyond `dark_range` on dark walls, not at a grazing
/// angle, from glass only if hit head on; the mean of all such hits in each square of `cell` [m].
TruePlan SeenPlan(World world, const LaserSimulatorOptions& laser,
                  const std::vector<Pose2>& world_from_base, double cell);

}  // namespace scan_image_slam
