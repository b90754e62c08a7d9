#include "scan_image_slam/core/mapping/grid_scan.h"

#include <cmath>

namespace scan_image_slam {

GridScan MakeGridScan(const FusedModel& model, const Velocity2& sweep_correction,
                      const OccupancyGridOptions& options) {
  GridScan scan;
  scan.origin = model.base_from_laser.translation();
  scan.beams.reserve(model.beams.size());
  for (const ModelBeam& beam : model.beams) {
    if (beam.hit() && beam.range <= options.max_range) {
      const Eigen::Vector2d end = Move(sweep_correction, beam.time_offset) * beam.point;
      scan.beams.push_back({end.cast<float>(), true});
      continue;
    }
    const bool far_hit = beam.hit();
    const bool clears =
        far_hit || options.no_return_policy == NoReturnPolicy::kClearToMaxLegacy ||
        (options.no_return_policy == NoReturnPolicy::kClearToMax && std::isinf(beam.range));
    if (!clears) continue;
    const double heading = model.HeadingOf(beam);
    const Velocity2 velocity = model.sweep_velocity + sweep_correction;
    const Eigen::Vector2d end =
        scan.origin + options.max_range * Eigen::Vector2d(std::cos(heading), std::sin(heading));
    const Eigen::Vector2d moved = Move(velocity, beam.time_offset) * end;
    scan.beams.push_back({moved.cast<float>(), false});
  }
  return scan;
}

}  // namespace scan_image_slam
