#pragma once

#include "scan_image_slam/core/simulation/scene_view.h"

#include <memory>

#include <opencv2/core.hpp>

namespace scan_image_slam {

/// Draws what a levelled camera sees into a bearing grid. Edges are area filtered: every cell of
/// the grid is the mean over the part of the scene that it covers.
class SceneRenderer {
 public:
  virtual ~SceneRenderer() = default;

  /// One matrix line per column of the grid, one element per row; CV_8UC1 or CV_8UC4 (blue, green,
  /// red, 0). Valid until the next call.
  virtual const cv::Mat& Render(const SceneView& view) = 0;
};

/// `world` must outlive the renderer.
std::unique_ptr<SceneRenderer> MakeSceneRenderer(const World& world, const BearingGrid& grid,
                                                 bool colour);

}  // namespace scan_image_slam
