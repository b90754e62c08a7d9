#pragma once

#include "scan_image_slam/core/fusion/fused_model.h"
#include "scan_image_slam/core/fusion/scan_image_fusion.h"
#include "scan_image_slam/core/matching/matched_motion.h"

#include <opencv2/core.hpp>

namespace scan_image_slam {

/// What the fusion saw in its last image, and what the matching made of it, drawn into the camera's
/// picture (CV_8UC3): the region of interest, the beams where they meet the walls (near red, far
/// blue), the vertical edges (orange: darker on the left, cyan: darker on the right), and below it
/// their strength by bearing, the accumulated histogram H. Edges that were matched are as thick as
/// they are strong, with a white line to where they were expected, 20 times as far away; new ones
/// are thin, those left out violet, refused ones red. `model` is that of the image, `match` that of
/// the model; null: the matching is not known. Empty if the fusion has no image yet.
cv::Mat DrawFusion(const ScanImageFusion& fusion, const FusedModel& model,
                   const MatchedMotion* match);

}  // namespace scan_image_slam
