#pragma once

#include "scan_image_slam/core/calibration/calibration_recorder.h"
#include "scan_image_slam/core/calibration/jump_sight.h"

#include <opencv2/core.hpp>

namespace scan_image_slam {

/// The snapshot of a recorder twice, one above the other: the laser's hits (near red, far blue) and
/// range discontinuities (white bars) as the camera should see them by what was assumed, and by
/// the correction; over the vertical edges that it does see (orange). `fusion` is the one that made
/// the snapshot. CV_8UC3; empty if there is no snapshot.
cv::Mat DrawCalibration(const CalibrationRecorder& recorder, const ScanImageFusion& fusion,
                        const CalibrationVector& correction);

}  // namespace scan_image_slam
