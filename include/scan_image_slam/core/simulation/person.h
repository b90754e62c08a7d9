#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

namespace scan_image_slam {

/// Somebody walks along way points, each reached at its time, and stands before the first and
/// after the last; with `loop` the walk begins again when it is over.
struct Person {
  struct WayPoint {
    Eigen::Vector2d position{0, 0};  ///< [m]
    double time = 0.0;               ///< since the start of the simulation [s]
  };
  std::vector<WayPoint> path;  ///< at least one, times increase
  bool loop = false;
  double height = 1.75;      ///< [m]
  double leg_radius = 0.07;  ///< [m]
  int trousers = 0;          ///< index into World::faces
  int shirt = 0;
  int head = 0;
};

/// Where a person is at one moment, with one leg ahead of the other while walking.
struct Posture {
  Eigen::Vector2d position{0, 0};       ///< of the body [m]
  double heading = 0.0;                 ///< [rad]
  double speed = 0.0;                   ///< [m/s]
  std::array<Eigen::Vector2d, 2> legs;  ///< centres at knee height [m]
};
Posture PostureAt(const Person& person, double time);

/// Largest distance of any part from Posture::position [m].
constexpr double kPersonRadius = 0.45;

struct Wall;
/// What a camera sees of the person: an upright prism for each leg, the trunk and the head.
std::vector<Wall> BodyWalls(const Person& person, double time);

}  // namespace scan_image_slam
