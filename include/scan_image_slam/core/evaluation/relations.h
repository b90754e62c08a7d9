#pragma once

#include "scan_image_slam/core/evaluation/statistics.h"
#include "scan_image_slam/core/evaluation/trajectory.h"
#include "scan_image_slam/core/evaluation/trajectory_lookup.h"

#include <cstddef>
#include <istream>
#include <string>
#include <vector>

namespace scan_image_slam {

/// True motion between two moments, as somebody verified it by hand.
struct Relation {
  Stamp first = 0;          ///< [ns]
  Stamp second = 0;         ///< [ns], may be earlier than `first`
  Pose2 first_from_second;  ///< pose at `second` seen from the pose at `first`
};

/// Reads lines `time1 time2 x y z roll pitch yaw` (seconds, metres, radians), comments begin with
/// `#`. z, roll and pitch are left out. Throws std::runtime_error, with line and reason, as
/// ReadTum.
std::vector<Relation> ReadRelations(std::istream& input, const std::string& source);

/// The same from a file; throws std::runtime_error if it cannot be opened.
std::vector<Relation> ReadRelationsFile(const std::string& path);

struct RelationErrorOptions {
  /// Scans of the public logs come every 0.2 s, now and then one is missing.
  LookupLimits lookup{0.5, 0.02};
};

struct RelationErrors {
  std::size_t relations = 0;
  std::size_t used = 0;    ///< of these with both moments in the trajectory
  Statistics translation;  ///< [m]; the square of its rms is the mean squared error [m^2]
  Statistics rotation;     ///< absolute values [rad]
};

/// Kuemmerle, Steder, Dornhege, Ruhnke, Grisetti, Stachniss, Kleiner: On Measuring the Accuracy of
/// SLAM Algorithms (Autonomous Robots 27(4), 2009). For each relation with the true motion d* and
/// the estimated motion d = P_first^-1 P_second, the error is d^-1 d*: the length of its
/// translation and its angle. Needs no common frame and does not count one early mistake over and
/// over. Throws std::runtime_error if no relation can be used.
RelationErrors EvaluateRelations(const std::vector<Relation>& relations, const Trajectory& estimate,
                                 const RelationErrorOptions& options);

/// One line of key=value pairs; metres and degrees.
std::string ToKeyValues(const RelationErrors& errors);

}  // namespace scan_image_slam
