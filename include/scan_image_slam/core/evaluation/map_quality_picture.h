#pragma once

#include "scan_image_slam/core/evaluation/map_quality.h"

#include <opencv2/core.hpp>

namespace scan_image_slam {

/// The map over the true walls: occupied cells at a wall black, others red, seen points that the
/// map lacks orange, true walls green. Empty if there is nothing to draw.
cv::Mat DrawMapQuality(const MapImage& map, const TruePlan& plan, const Pose2& world_from_map,
                       const MapQuality& quality, int largest_side = 2500);

}  // namespace scan_image_slam
