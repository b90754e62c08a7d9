#pragma once

#include "scan_image_slam/core/geometry/pose2.h"
#include "scan_image_slam/core/mapping/map_file.h"

#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace scan_image_slam {

/// A path to be drawn into a map, in the map's frame.
struct DrawnPath {
  std::string name;
  cv::Scalar colour;  ///< blue, green, red
  std::vector<Pose2> poses;
};

/// Colours of the paper's Fig. 7: the estimate is green, the encoders are blue.
inline const cv::Scalar kEstimateColour(40, 160, 0);
inline const cv::Scalar kEncoderColour(220, 90, 30);

/// The map as a picture for people: walls black, free white, unknown grey, paths, and below it a
/// scale bar and a legend. Paths are cut where they leave the map by more than half of its size.
/// `largest_side` of the map in pixels, but at least one pixel per cell. Empty if there is nothing
/// to draw.
cv::Mat DrawMap(const MapImage& map, const std::vector<DrawnPath>& paths, int largest_side = 1600);

}  // namespace scan_image_slam
