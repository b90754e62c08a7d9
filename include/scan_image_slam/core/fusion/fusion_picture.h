#pragma once

#include "scan_image_slam/core/fusion/fused_model.h"
#include "scan_image_slam/core/fusion/scan_image_fusion.h"

#include <opencv2/core.hpp>

namespace scan_image_slam {

/// What the fusion saw, drawn into the camera's picture (CV_8UC3): the region of interest, the
/// beams where they meet the walls (near red, far blue), the vertical edges (orange: darker on the
/// left, cyan: darker on the right), and below it their strength by bearing, the accumulated
/// histogram H. Empty if the fusion has no image yet.
cv::Mat DrawFusion(const ScanImageFusion& fusion, const FusedModel& model);

}  // namespace scan_image_slam
