#include "scan_image_slam/core/mapping/map_picture.h"

#include "scan_image_slam/core/mapping/map_canvas.h"

#include <Eigen/Geometry>

namespace scan_image_slam {
namespace {

std::vector<Eigen::Vector2d> PointsOf(const DrawnPath& path) {
  std::vector<Eigen::Vector2d> points;
  for (const Pose2& pose : path.poses) points.push_back(pose.translation());
  return points;
}

/// The map, and half of its size around it.
Eigen::AlignedBox2d Surroundings(const MapImage& map) {
  const Eigen::Vector2d corner(map.origin_x, map.origin_y);
  const Eigen::Vector2d size = map.resolution * Eigen::Vector2d(map.width, map.height);
  const Eigen::Vector2d margin = Eigen::Vector2d::Constant(0.5 * size.maxCoeff());
  return {corner - margin, corner + size + margin};
}

}  // namespace

cv::Mat DrawMap(const MapImage& map, const std::vector<DrawnPath>& paths, int largest_side) {
  // Paths may leave the map, as the encoders' do: the picture grows to hold them, within reason.
  const Eigen::AlignedBox2d reach = Surroundings(map);
  std::vector<Eigen::Vector2d> all;
  std::vector<LegendEntry> legend;
  for (const DrawnPath& path : paths) {
    for (const Eigen::Vector2d& point : PointsOf(path)) {
      if (map.occupancy.empty() || reach.contains(point)) all.push_back(point);
    }
    legend.push_back({path.name, path.colour});
  }
  MapCanvas canvas(map, all, largest_side);
  if (canvas.picture().empty()) return {};
  for (const DrawnPath& path : paths) {
    canvas.DrawLine(PointsOf(path), path.colour, 2);
    if (!path.poses.empty()) canvas.DrawDot(path.poses.back().translation(), path.colour, 6);
  }
  return canvas.Captioned(legend);
}

}  // namespace scan_image_slam
