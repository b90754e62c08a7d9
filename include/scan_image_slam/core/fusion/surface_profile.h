#pragma once

#include "scan_image_slam/core/fusion/bearing_image.h"
#include "scan_image_slam/core/fusion/fused_model.h"

#include <vector>

#include <Eigen/Core>

namespace scan_image_slam {

/// The surface that the laser sees in each column of a bearing image. Where two surfaces share a
/// column, at a range discontinuity, it is the nearer one.
struct SurfaceProfile {
  struct Column {
    double distance = 0.0;  ///< from the camera's centre, horizontally [m]; 0: no surface
    int beam = -1;          ///< index of the nearest beam of the model
  };
  std::vector<Column> columns;
};

/// `points` are the hits of the model in the base frame at the time of the image, one for each
/// beam.
SurfaceProfile MakeSurfaceProfile(const FusedModel& model,
                                  const std::vector<Eigen::Vector2d>& points,
                                  const BearingImage& image);

}  // namespace scan_image_slam
