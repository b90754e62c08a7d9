#pragma once

#include "scan_image_slam/core/fusion/bearing_image.h"
#include "scan_image_slam/core/fusion/surface_profile.h"

#include <vector>

#include <opencv2/core.hpp>

namespace scan_image_slam {

struct EdgeExtractionOptions {
  double roi_below = 0.25;  ///< how far the region of interest reaches below the laser's plane [m]
  double roi_above = 1.8;   ///< and above it [m]
  double edge_threshold = 10.7;   ///< step that makes an edge pixel [grey levels]
  double min_edge_length = 0.15;  ///< vertical run of an edge [m]
  double min_edge_rows = 8.0;     ///< and in rows of the picture [px]
  double column_tolerance = 1.5;  ///< runs of one edge lie so near to each other [px]
  /// Throws std::invalid_argument, naming the field, if a value is out of range.
  void Validate() const;
};

/// A vertical edge in a bearing image.
struct ImageEdge {
  double column = 0.0;         ///< [px]
  double column_stddev = 0.0;  ///< [px]
  int sign = 0;                ///< +1: darker on the left; -1: darker on the right
  double strength = 0.0;       ///< accumulated by eq. 1; about twice the rows of vertical edge [px]
  double weight = 0.0;         ///< share of the rows of the region of interest in this column [-]
  double contrast = 0.0;       ///< step at the edge [grey levels]
  int top = 0;                 ///< first and last row of the edge in the bearing image
  int bottom = 0;
};

/// The rows [top, bottom] that the region of interest has in each column; bottom < top: none.
struct RegionOfInterest {
  std::vector<int> top;
  std::vector<int> bottom;
  int begin = 0;  ///< rows [begin, end) hold all of it
  int end = 0;
};

/// The band around the laser's line on the surfaces of the profile. `laser_height` in the base
/// frame [m].
RegionOfInterest MakeRegionOfInterest(const SurfaceProfile& profile, const BearingImage& image,
                                      double laser_height, const EdgeExtractionOptions& options);

/// Vertical edges of the region of interest, by the filter of the paper. `grey` is the camera's
/// picture, CV_8U.
std::vector<ImageEdge> ExtractEdges(const cv::Mat& grey, const BearingImage& image,
                                    const SurfaceProfile& profile, const RegionOfInterest& region,
                                    const EdgeExtractionOptions& options);

}  // namespace scan_image_slam
