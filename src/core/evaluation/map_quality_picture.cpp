#include "scan_image_slam/core/evaluation/map_quality_picture.h"

#include "scan_image_slam/core/mapping/map_canvas.h"

namespace scan_image_slam {
namespace {

const cv::Scalar kRight(0, 0, 0);  // blue, green, red
const cv::Scalar kFalse(0, 0, 230);
const cv::Scalar kMissed(0, 140, 255);
const cv::Scalar kTruth(60, 190, 60);

}  // namespace

cv::Mat DrawMapQuality(const MapImage& map, const TruePlan& plan, const Pose2& world_from_map,
                       const MapQuality& quality, int largest_side) {
  const RigidTransform2 to_map(world_from_map.Inverse());
  std::vector<Eigen::Vector2d> ends;
  for (const TrueWall& wall : plan.walls) {
    ends.push_back(to_map * wall.from);
    ends.push_back(to_map * wall.to);
  }
  MapCanvas canvas(map, ends, largest_side);
  if (canvas.picture().empty()) return {};
  for (const Eigen::Vector2i& cell : quality.right_cells) {
    canvas.FillCell(cell.x(), cell.y(), kRight);
  }
  for (const Eigen::Vector2i& cell : quality.false_cells) {
    canvas.FillCell(cell.x(), cell.y(), kFalse);
  }
  for (const TrueWall& wall : plan.walls) {
    canvas.DrawLine({to_map * wall.from, to_map * wall.to}, kTruth, 1);
  }
  for (const Eigen::Vector2d& point : quality.missed) canvas.DrawDot(point, kMissed, 2);
  return canvas.Captioned({{"occupied, at a true wall", kRight},
                           {"occupied, no wall", kFalse},
                           {"seen, not in the map", kMissed},
                           {"true wall", kTruth}});
}

}  // namespace scan_image_slam
