#pragma once

#include "scan_image_slam/core/geometry/pose2.h"
#include "scan_image_slam/core/matching/match_outcome.h"
#include "scan_image_slam/core/matching/search_window.h"
#include "scan_image_slam/core/sensor/stamp.h"

#include <optional>

#include <Eigen/Core>

namespace scan_image_slam {

/// What a pose rests on.
enum class MatchMode {
  kFull,        ///< laser, camera and encoders
  kNoCamera,    ///< laser and encoders
  kNoEncoders,  ///< laser and camera, constant velocity
  kLaserOnly,   ///< laser, constant velocity
  kCoasting,    ///< no laser: encoders alone, or constant velocity
};

/// After so long without a scan the pose rests on what else there is: kCoasting [s].
constexpr double kLaserGap = 0.5;

/// As in the report of a run and in diagnostics.
inline const char* ModeName(MatchMode mode) {
  switch (mode) {
    case MatchMode::kFull:
      return "full";
    case MatchMode::kNoCamera:
      return "no_camera";
    case MatchMode::kNoEncoders:
      return "no_encoders";
    case MatchMode::kLaserOnly:
      return "laser_only";
    case MatchMode::kCoasting:
      return "coasting";
  }
  return "unknown";
}

/// What became of one match.
enum class MatchStatus {
  kFirst,         ///< nothing to match with yet
  kMatched,       ///< the best motion lies inside the window
  kOnWindowEdge,  ///< the best motion lies on the border: the encoders were more wrong than allowed
  kDegenerate,    ///< matched, but one direction was left to the prediction
  kTooFewPoints,  ///< the scan shows too little of the reference: mostly the prediction
};

/// The motion of the base from a reference scan to this one, and the evidence for it.
struct MatchedMotion : MatchEvidence {
  Stamp stamp = 0;             ///< time of this scan [ns]
  Stamp start_stamp = 0;       ///< time of the first scan: another value is another chain [ns]
  Stamp reference_stamp = 0;   ///< time of the reference scan [ns]
  Pose2 start_from_reference;  ///< pose of the reference in the frame of the first scan
  Pose2 motion;                ///< reference_from_base
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of (forward, left, turn) of the pose
                                                         ///< since the last scan [m, m, rad]
  MatchMode mode = MatchMode::kNoCamera;
  MatchStatus status = MatchStatus::kFirst;
  SearchWindow window;                  ///< D and Phi
  std::optional<Pose2> odom_from_base;  ///< what the encoders say at the stamp

  Pose2 start_from_base() const { return start_from_reference * motion; }
};

}  // namespace scan_image_slam
