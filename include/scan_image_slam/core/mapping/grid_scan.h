#pragma once

#include "scan_image_slam/core/fusion/fused_model.h"
#include "scan_image_slam/core/geometry/pose2.h"
#include "scan_image_slam/core/mapping/occupancy_grid.h"

namespace scan_image_slam {

/// The beams of a model as the grid takes them, in the base frame at the model's stamp: hits within
/// reach, and rays that clear what lies before a far hit or, by `no_return_policy`, before nothing.
/// `sweep_correction` is what the matching found the velocity of the sweep to be wrong by.
GridScan MakeGridScan(const FusedModel& model, const Velocity2& sweep_correction,
                      const OccupancyGridOptions& options);

}  // namespace scan_image_slam
