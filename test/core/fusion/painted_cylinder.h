#pragma once

#include "scan_image_slam/core/fusion/edge_extraction.h"
#include "support_fusion.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace scan_image_slam {

inline EdgeExtractionOptions ExtractionOptions() {
  EdgeExtractionOptions options;
  options.edge_threshold = 8.0;
  options.min_edge_length = 0.15;
  options.min_edge_rows = 8.0;
  options.column_tolerance = 1.5;
  return options;
}

/// Rows below are counted in pixels of the camera, of which a row of the bearing image has several.
constexpr int kRow = BearingImage::kRowPixels;

/// Paint in a bearing image: rows [top, bottom] and columns [left, right) in its grey.
struct Patch {
  double left;
  double right;
  int top;
  int bottom;
  double grey;
};

/// A level camera before a grey cylinder around it, on which patches are painted.
class PaintedCylinder : public ::testing::Test {
 protected:
  PaintedCylinder() : image_(CameraModel(PinholeCamera()), CameraView().FromOptical()) {
    SetSurface(3.0);
    SetRegion(60, 159);
  }

  /// The same rows [top, bottom] in all columns, whole ones of the bearing image.
  void SetRegion(int top, int bottom) {
    region_.top.assign(image_.columns(), top / kRow);
    region_.bottom.assign(image_.columns(), bottom / kRow);
    region_.begin = top / kRow;
    region_.end = bottom / kRow + 1;
  }

  void SetSurface(double distance) { profile_.columns.assign(image_.columns(), {distance, 0}); }

  /// `grey(column, row)` is the paint at a column of the bearing image and a row of pixels.
  template <typename Grey>
  std::vector<ImageEdge> ExtractFrom(const Grey& grey, const EdgeExtractionOptions& options) const {
    const auto shade = [&](const Eigen::Vector3d&, const Eigen::Vector3d& ray) {
      return grey(image_.Column(std::atan2(ray.y(), ray.x())),
                  kRow * image_.Row(ray.z() / std::hypot(ray.x(), ray.y())) + 0.5 * (kRow - 1));
    };
    const cv::Mat picture = RenderPicture(PinholeCamera(), CameraView().FromOptical(), shade);
    return ExtractEdges(picture, image_, profile_, region_, options);
  }

  std::vector<ImageEdge> Extract(const std::vector<Patch>& patches,
                                 const EdgeExtractionOptions& options = ExtractionOptions()) const {
    const auto grey = [&](double column, double row) {
      double level = 180.0;
      for (const Patch& p : patches) {
        const bool in_rows = p.top - 0.5 <= row && row < p.bottom + 0.5;
        if (in_rows && p.left <= column && column < p.right) level = p.grey;
      }
      return level;
    };
    return ExtractFrom(grey, options);
  }

  BearingImage image_;
  SurfaceProfile profile_;
  RegionOfInterest region_;
};

}  // namespace scan_image_slam
