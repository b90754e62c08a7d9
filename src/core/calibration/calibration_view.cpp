#include "scan_image_slam/core/calibration/calibration_view.h"

#include "scan_image_slam/core/calibration/upright_edges.h"

#include <algorithm>
#include <cmath>

namespace scan_image_slam {
namespace {

/// How far an edge may end above or below the laser's plane on the surface that it belongs to: the
/// camera's height and attitude are known so badly [m].
constexpr double kHeightMargin = 0.12;

std::vector<ViewedEdge> ViewedEdges(const ScanImageFusion& fusion) {
  const FusionEvidence& evidence = fusion.evidence();
  const BearingImage& image = *fusion.bearing_image();
  const double below = fusion.laser().height - image.centre().z();
  std::vector<ViewedEdge> edges;
  for (const UprightEdge& edge : FindUprightEdges(evidence.image.grey, image, evidence.region.begin,
                                                  evidence.region.end, fusion.options().edges)) {
    const int column =
        std::clamp(static_cast<int>(std::lround(edge.column)), 0, image.columns() - 1);
    const double distance = evidence.profile.columns[column].distance;
    if (distance <= 0.0) continue;
    if (edge.top > image.Row((below - kHeightMargin) / distance) ||
        edge.bottom < image.Row((below + kHeightMargin) / distance)) {
      continue;
    }
    const double row = std::clamp(image.Row(below / distance), edge.top - 0.0, edge.bottom + 0.0);
    const double lean = image.step() / image.row_step();  // of one column per row [rad]
    edges.push_back({image.Bearing(edge.ColumnAt(row)), image.Slope(row), edge.lean * lean,
                     edge.lean_stddev * lean});
  }
  std::sort(edges.begin(), edges.end(),
            [](const ViewedEdge& a, const ViewedEdge& b) { return a.bearing < b.bearing; });
  return edges;
}

}  // namespace

CalibrationView MakeCalibrationView(const ScanImageFusion& fusion, const FusedModel& model,
                                    const RangeJumpOptions& options) {
  CalibrationView view;
  view.stamp = fusion.evidence().image.stamp;
  view.edges = ViewedEdges(fusion);
  for (const RangeJump& jump : FindRangeJumps(model, options)) {
    const Eigen::Vector2d ray(std::cos(jump.heading), std::sin(jump.heading));
    view.jumps.push_back({model.stamp + FromSeconds(jump.time_offset),
                          model.base_from_laser.translation() + jump.range * ray, jump.side,
                          jump.stddev});
  }
  return view;
}

}  // namespace scan_image_slam
