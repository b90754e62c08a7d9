#include "scan_image_slam/core/simulation/world.h"

#include <algorithm>
#include <limits>

namespace scan_image_slam {
namespace {

double DistanceToSegment(const Eigen::Vector2d& point, const Eigen::Vector2d& from,
                         const Eigen::Vector2d& to) {
  const Eigen::Vector2d along = to - from;
  const double length2 = along.squaredNorm();
  const double t = length2 > 0.0 ? (point - from).dot(along) / length2 : 0.0;
  return (point - from - std::clamp(t, 0.0, 1.0) * along).norm();
}

}  // namespace

int World::AddFace(const Face& face) {
  faces.push_back(face);
  return static_cast<int>(faces.size()) - 1;
}

int World::AddWall(const Wall& wall, const Face& face) {
  walls.push_back(wall);
  walls.back().face = AddFace(face);
  return static_cast<int>(walls.size()) - 1;
}

int World::AddPicture(const PictureSpec& picture) {
  const auto found = std::find(pictures.begin(), pictures.end(), picture);
  const auto index = found - pictures.begin();
  if (found == pictures.end()) pictures.push_back(picture);
  return static_cast<int>(index);
}

double Clearance(const World& world, const Eigen::Vector2d& point, double height, double time) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Wall& wall : world.walls) {
    if (wall.bottom < height) {
      nearest = std::min(nearest, DistanceToSegment(point, wall.from, wall.to));
    }
  }
  for (const Person& person : world.people) {
    const double distance = (point - PostureAt(person, time).position).norm();
    nearest = std::min(nearest, std::max(distance - kPersonRadius, 0.0));
  }
  return nearest;
}

}  // namespace scan_image_slam
