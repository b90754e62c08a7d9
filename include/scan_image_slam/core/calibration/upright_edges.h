#pragma once

#include "scan_image_slam/core/fusion/scan_image_fusion.h"

#include <vector>

#include <opencv2/core.hpp>

namespace scan_image_slam {

constexpr double kEdgeStddev = 0.4;  ///< of the column of an edge [px]

/// A straight, nearly vertical edge of a bearing image: a line through columns and rows.
struct UprightEdge {
  double column = 0.0;       ///< at `row` [px]
  double row = 0.0;          ///< mean row of its pixels [px]
  double lean = 0.0;         ///< columns per row, 0 if it stands upright [-]
  double lean_stddev = 0.0;  ///< by the scatter of its pixels [-]
  double scatter = 0.0;      ///< of its pixels around the line [px]
  int top = 0;               ///< first and last row
  int bottom = 0;

  double ColumnAt(double at_row) const { return column + lean * (at_row - row); }
};

/// The line through pixels of an edge, after those beside it are left out; no rows (bottom < top)
/// if too few remain or they are not on one line.
UprightEdge FitUprightEdge(const std::vector<cv::Point2d>& pixels, double min_rows);

/// The edges of a picture in the rows [begin, end) of a bearing image.
std::vector<UprightEdge> FindUprightEdges(const cv::Mat& grey, const BearingImage& image, int begin,
                                          int end, const EdgeExtractionOptions& options);

}  // namespace scan_image_slam
