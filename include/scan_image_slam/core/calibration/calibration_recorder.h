#pragma once

#include "scan_image_slam/core/calibration/calibration_view.h"

namespace scan_image_slam {

/// What a picture of the calibration is made of.
struct CalibrationSnapshot {
  FusionEvidence evidence;
  FusedModel model;
};

struct CalibrationRecorderOptions {
  RangeJumpOptions jumps;
  double min_distance = 0.03;  ///< driven since the last view: what stands still says nothing new
                               ///< [m]
  double min_angle = 0.01;     ///< or turned [rad]
};

/// Gathers what a drive says of the camera's place.
class CalibrationRecorder {
 public:
  explicit CalibrationRecorder(const CalibrationRecorderOptions& options) : options_(options) {}

  /// One scan: the model that `fusion` has just made, and the pose of the base by the laser, in a
  /// frame that stays. Stamps must advance.
  void Add(const ScanImageFusion& fusion, const FusedModel& model, const Pose2& pose);

  const CalibrationData& data() const { return data_; }
  /// The view that shows most; without a picture if there was none.
  const CalibrationSnapshot& snapshot() const { return snapshot_; }

 private:
  bool HasMoved(const Pose2& pose) const;

  CalibrationRecorderOptions options_;
  CalibrationData data_;
  CalibrationSnapshot snapshot_;
  std::size_t shown_ = 0;  ///< edges and discontinuities of the snapshot
  Pose2 last_;
};

}  // namespace scan_image_slam
