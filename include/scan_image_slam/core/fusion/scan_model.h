#pragma once

#include "scan_image_slam/core/fusion/fused_model.h"
#include "scan_image_slam/core/sensor/laser_scan.h"

#include <Eigen/Geometry>

namespace scan_image_slam {

struct ScanModelOptions {
  double min_range = 0.05;            ///< nearer hits are the robot itself or noise [m]
  double max_range = 100.0;           ///< farther hits are not used [m]
  double field_of_view = 2.0 * M_PI;  ///< beams used, around the robot's front [rad]
  double min_beam_spacing = 0.0;      ///< beams nearer to the last used one are left out [rad]
  /// Throws std::invalid_argument, naming the field, if a value is out of range.
  void Validate() const;
};

/// Where a planar laser is on the robot.
struct LaserMount {
  Pose2 base_from_laser;     ///< [m, rad]
  double height = 0.0;       ///< of the laser's plane in the base frame [m]
  bool upside_down = false;  ///< mounted with its top down

  /// From the full transform. Throws std::invalid_argument if the laser does not scan a horizontal
  /// plane: tilted by more than 2 degrees.
  static LaserMount From(const Eigen::Isometry3d& base_from_laser);
};

/// The laser's part of the model: beams selected by angle, ranges told apart by REP-117, each point
/// moved by what the base moved between the stamp and the firing of its beam.
FusedModel MakeScanModel(const LaserScan& scan, const LaserMount& mount,
                         const Velocity2& base_velocity, const ScanModelOptions& options);

}  // namespace scan_image_slam
