#include "spots.h"

#include <algorithm>
#include <cmath>

namespace scan_image_slam {
namespace {

constexpr double kReach = 4.0;        // of a lamp [m]
constexpr double kBodyHeight = 0.9;   // [m]
constexpr double kBodyRadius = 0.22;  // [m]

/// A point in the frame of a wall: along its face, and away from it.
struct WallPoint {
  double along;
  double away;
};

WallPoint InWallFrame(const Wall& wall, const Eigen::Vector2d& point) {
  const Eigen::Vector2d edge = (wall.to - wall.from).normalized();
  const Eigen::Vector2d way = point - wall.from;
  return {wall.along_from + edge.dot(way), -edge.y() * way.x() + edge.x() * way.y()};
}

Spot Highlight(const WallPoint& camera, double camera_height, const WallPoint& lamp,
               double lamp_height, double strength) {
  // Where the straight way from the camera to the lamp's mirror image meets the wall.
  const double f = camera.away / (camera.away + lamp.away);
  Spot spot;
  spot.along = camera.along + f * (lamp.along - camera.along);
  spot.height = camera_height + f * (lamp_height - camera_height);
  spot.sigma_along = 0.05 + 0.05 * std::abs(lamp.away);
  spot.sigma_height = 4.0 * spot.sigma_along;
  spot.strength = strength / (1.0 + std::abs(lamp.away) / 2.0);
  return spot;
}

Spot Shadow(const WallPoint& robot, const WallPoint& lamp, double lamp_height, double strength) {
  const double f = lamp.away / (lamp.away - robot.away);  // from the lamp, over the robot, beyond
  Spot spot;
  spot.along = lamp.along + f * (robot.along - lamp.along);
  spot.sigma_along = 0.7 * kBodyRadius * f;
  const double top = lamp_height - f * (lamp_height - kBodyHeight);
  spot.sigma_height = 0.6 * std::max(top, 0.0);
  spot.strength = top > 0.0 ? strength : 0.0;
  spot.bright = false;
  return spot;
}

}  // namespace

std::vector<Spot> SpotsOn(const Wall& wall, const Lighting& lighting, const SceneView& view) {
  std::vector<Spot> spots;
  if (lighting.highlights <= 0.0 && lighting.shadows <= 0.0) return spots;
  const WallPoint camera = InWallFrame(wall, view.position);
  const WallPoint robot = InWallFrame(wall, view.robot);
  for (const Lamp& lamp : lighting.lamps) {
    const WallPoint source = InWallFrame(wall, lamp.position);
    if (source.away * camera.away <= 0.0 || std::abs(source.away) > kReach) continue;
    if (lighting.highlights > 0.0) {
      spots.push_back(Highlight(camera, view.height, source, lamp.height, lighting.highlights));
    }
    // Only a robot that is clearly nearer to the wall than the lamp casts a shadow on it.
    if (lighting.shadows > 0.0 && robot.away / source.away < 0.9) {
      spots.push_back(Shadow(robot, source, lamp.height, lighting.shadows));
    }
  }
  spots.erase(std::remove_if(spots.begin(), spots.end(),
                             [](const Spot& spot) {
                               return spot.strength < 0.01 || spot.sigma_height < 0.02;
                             }),
              spots.end());
  return spots;
}

}  // namespace scan_image_slam
