#include "scan_image_slam/core/calibration/calibration_recorder.h"

#include <algorithm>
#include <cmath>

namespace scan_image_slam {

void CalibrationRecorder::Add(const ScanImageFusion& fusion, const FusedModel& model,
                              const Pose2& pose) {
  data_.trajectory.push_back({model.stamp, pose});
  if (!model.has_image) return;
  if (!data_.views.empty() && !HasMoved(pose)) return;
  last_ = pose;
  data_.camera = fusion.bearing_image()->centre().head<2>();
  data_.pixel = fusion.bearing_image()->step();
  data_.views.push_back(MakeCalibrationView(fusion, model, options_.jumps));
  const CalibrationView& view = data_.views.back();
  const std::size_t shows = std::min(view.edges.size(), view.jumps.size());
  if (shows <= shown_) return;
  shown_ = shows;
  snapshot_ = {fusion.evidence(), model};
  // The picture may be a view of a message whose memory is used again.
  snapshot_.evidence.image.grey = snapshot_.evidence.image.grey.clone();
}

bool CalibrationRecorder::HasMoved(const Pose2& pose) const {
  const Pose2 motion = last_.Inverse() * pose;
  return motion.translation().norm() >= options_.min_distance ||
         std::abs(motion.theta) >= options_.min_angle;
}

}  // namespace scan_image_slam
