#pragma once

#include "scan_image_slam/core/evaluation/statistics.h"
#include "scan_image_slam/core/evaluation/trajectory.h"

#include <cstddef>
#include <string>
#include <vector>

namespace scan_image_slam {

/// Which rigid motion S carries the estimate into the frame of the reference.
enum class Alignment {
  kFirst,  ///< makes the first poses coincide: shows the whole drift
  kBest,   ///< smallest sum of squared distances (Umeyama 1991, in the plane, without scale)
  kNone,   ///< none: both are in one frame already
};

struct TrajectoryErrorOptions {
  Alignment alignment = Alignment::kFirst;
  double max_gap = 0.25;  ///< between two reference poses that are interpolated [s]
  /// Throws std::invalid_argument, naming the field, if a value is negative or not finite.
  void Validate() const;
};

/// Pose of the estimate with the reference's pose at the same time, each in its own frame.
struct PosePair {
  Stamp stamp = 0;  ///< of the estimate [ns]
  Pose2 reference;
  Pose2 estimate;
};

/// The poses of the estimate at whose stamps the reference is known: interpolated between reference
/// poses that are at most `max_gap` [s] apart.
std::vector<PosePair> Associate(const Trajectory& reference, const Trajectory& estimate,
                                double max_gap);

/// The motion S = reference_from_estimate. `pairs` must not be empty.
Pose2 Align(const std::vector<PosePair>& pairs, Alignment alignment);

/// Relative errors over windows of one length (see EvaluateTrajectory).
struct RelativeErrors {
  Statistics translation;  ///< [m]
  Statistics rotation;     ///< absolute values [rad]
};

struct TrajectoryErrors {
  std::size_t poses = 0;          ///< of the estimate
  std::size_t matched = 0;        ///< of these with a reference
  double coverage = 0.0;          ///< time between first and last match over that of the reference
  Statistics position;            ///< absolute trajectory error [m]
  double final_position = 0.0;    ///< of the last match [m]
  Statistics yaw;                 ///< absolute values [rad]
  double final_yaw = 0.0;         ///< absolute value [rad]
  RelativeErrors per_metre;       ///< over 1 m of the reference's way
  RelativeErrors per_ten_metres;  ///< over 10 m of the reference's way
  RelativeErrors per_second;      ///< over 1 s
  double path = 0.0;              ///< way of the reference through the matches [m]
  double drift = 0.0;             ///< position error from the first to the last match, over `path`
};

/// Absolute and relative errors as in Sturm, Engelhard, Endres, Burgard, Cremers: A Benchmark for
/// the Evaluation of RGB-D SLAM Systems (IROS 2012). With reference poses Q_i and estimated poses
/// P_i at the same times:
/// - ATE: F_i = Q_i^-1 S P_i with the alignment S; its translation and rotation.
/// - RPE: E_i = (Q_i^-1 Q_j)^-1 (P_i^-1 P_j), where j is the pose at which the reference has driven
///   nearest to 1 m (10 m) further than at i, or that is nearest to 1 s later; windows that are
///   more than a tenth too long or too short are left out. Starts follow each other by a hundredth
///   of the window at least, so that a robot that stands still does not count many times.
/// - drift: translation of E from the first to the last match, divided by the way. On a round trip
/// it
///   tells how well the ends meet; the error on the way is told by the RPE.
/// Neither RPE nor drift depend on S. Throws std::runtime_error if fewer than two poses match.
TrajectoryErrors EvaluateTrajectory(const Trajectory& reference, const Trajectory& estimate,
                                    const TrajectoryErrorOptions& options);

/// One line of key=value pairs; metres, degrees, percent.
std::string ToKeyValues(const TrajectoryErrors& errors);

}  // namespace scan_image_slam
