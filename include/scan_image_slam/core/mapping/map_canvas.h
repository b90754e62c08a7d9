#pragma once

#include "scan_image_slam/core/mapping/map_file.h"

#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace scan_image_slam {

/// Line of a legend.
struct LegendEntry {
  std::string name;
  cv::Scalar colour;  ///< blue, green, red
};

/// A map as a picture, walls black, free white, unknown grey, to be drawn into in the map's frame.
class MapCanvas {
 public:
  /// As large as to hold the map and these points [m]; `largest_side` in pixels, but at least one
  /// pixel per cell.
  MapCanvas(const MapImage& map, const std::vector<Eigen::Vector2d>& points, int largest_side);

  /// Empty if there is nothing to draw.
  const cv::Mat& picture() const { return picture_; }

  void FillCell(int column, int row, const cv::Scalar& colour);  ///< of the map
  void DrawLine(const std::vector<Eigen::Vector2d>& points, const cv::Scalar& colour,
                int thickness);                                                      ///< [px]
  void DrawDot(const Eigen::Vector2d& point, const cv::Scalar& colour, int radius);  ///< [px]

  /// The picture above a strip with a bar of one, two or five metres (or ten times as many) and a
  /// legend. Wider than the picture if the strip is.
  cv::Mat Captioned(const std::vector<LegendEntry>& legend) const;

 private:
  cv::Point At(const Eigen::Vector2d& point) const;
  double BarLength() const;  // [m]

  cv::Mat picture_;
  Eigen::Vector2d corner_{0, 0};  // upper left, in the map's frame [m]
  double resolution_;
  int scale_ = 1;  // pixels per cell
  int left_ = 0;   // cells of the picture on the left of the map
  int below_ = 0;  // and below it
};

}  // namespace scan_image_slam
