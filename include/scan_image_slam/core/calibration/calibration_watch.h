#pragma once

#include "scan_image_slam/core/calibration/jump_sight.h"
#include "scan_image_slam/core/fusion/scan_image_fusion.h"

#include <deque>
#include <optional>

namespace scan_image_slam {

/// By how much the camera seems to be other than assumed. Errors of its place look like these, too.
struct CameraMisfit {
  double yaw = 0.0;  ///< to be added to the camera's, to the left [rad]
  double yaw_stddev = 0.0;
  double time_offset = 0.0;  ///< to be added to the stamps of the pictures [s]
  double time_offset_stddev = 0.0;
};

/// Watches whether the camera fits the laser while the robot drives: vertical edges of the pictures
/// must lie on range discontinuities of the scans, also while it turns. It needs no map, only the
/// encoders for the moment between picture and scan. `Calibrate` tells more, afterwards.
class CalibrationWatch {
 public:
  /// The model that `fusion` has just made. What stands still says nothing new.
  void Add(const ScanImageFusion& fusion, const FusedModel& model);

  /// By the latest 2000 pairs of an edge and a discontinuity, or those of the latest 100 views if
  /// that is more: some seconds of driving where much is in view, minutes where little is. Nothing
  /// if too little was seen, or if edges do not lie on discontinuities with any yaw up to 4 degrees
  /// and any time up to 0.1 s.
  std::optional<CameraMisfit> Misfit() const;

  /// An edge near a discontinuity of the same view, whether they belong together or not.
  struct Pair {
    double residual = 0.0;  ///< how far the edge lies to the left of the discontinuity [rad]
    double by_time = 0.0;   ///< how that grows with the time added to the picture's stamp [rad/s]
    double stddev = 0.0;    ///< [rad]
    int view = 0;           ///< number in the order of time
  };

 private:
  bool HasMoved(const Pose2& odom_from_base) const;
  void AddPairs(const JumpSight& sight, const FusionEvidence& evidence, const BearingImage& image);

  int Views() const;

  std::deque<Pair> pairs_;
  int view_ = 0;  ///< the last one
  Pose2 last_;    ///< of the base by the encoders, when something was added
};

}  // namespace scan_image_slam
