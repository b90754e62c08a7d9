#pragma once

#include "scan_image_slam/core/geometry/pose2.h"
#include "scan_image_slam/core/sensor/stamp.h"

#include <istream>
#include <ostream>
#include <string>
#include <vector>

namespace scan_image_slam {

struct StampedPose {
  Stamp stamp = 0;  ///< [ns]
  Pose2 pose;       ///< of the base in the frame of the trajectory
};

/// Poses in the order of time; no stamp occurs twice.
using Trajectory = std::vector<StampedPose>;

/// Reads the TUM format: lines `timestamp tx ty tz qx qy qz qw` (seconds, metres, unit quaternion),
/// comments begin with `#`. Stamps are exact to the nanosecond. The pose in the plane is (tx, ty)
/// and the yaw of the quaternion; tz, roll and pitch are left out. `source` is the name for errors.
/// Throws std::runtime_error, with line and reason, for a wrong number of columns, a value that is
/// not a finite number, a quaternion whose norm is more than 1 % off, a stamp that does not
/// increase, and if there is no pose at all.
Trajectory ReadTum(std::istream& input, const std::string& source);

/// The same from a file; throws std::runtime_error if it cannot be opened.
Trajectory ReadTumFile(const std::string& path);

/// Writes the TUM format, nine decimals everywhere: stamps come back exactly, poses to the
/// nanometre. The same bytes whatever the locale. Throws std::invalid_argument if a pose is not
/// finite, std::runtime_error if the stream fails.
void WriteTum(std::ostream& output, const Trajectory& trajectory);

/// The same into a file, which is replaced; throws std::runtime_error if it cannot be written.
void WriteTumFile(const std::string& path, const Trajectory& trajectory);

}  // namespace scan_image_slam
