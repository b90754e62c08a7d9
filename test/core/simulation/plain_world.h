#pragma once

#include "scan_image_slam/core/simulation/motion_history.h"
#include "scan_image_slam/core/simulation/scenario.h"

namespace scan_image_slam {

/// Worlds without texture, to compute by hand in.

inline Face PlainFace(double grey) {
  Face face;
  face.colour = {grey, grey, grey};
  return face;
}

inline World EmptyWorld() {
  World world;
  world.floor = PlainFace(100.0);
  world.ceiling = PlainFace(220.0);
  return world;
}

inline int AddPlainWall(World& world, const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                        double grey = 180.0) {
  Wall wall;
  wall.from = from;
  wall.to = to;
  wall.top = world.ceiling_height;
  return world.AddWall(wall, PlainFace(grey));
}

/// A closed room of plain walls, [0, x] by [0, y].
inline World PlainRoom(double x, double y) {
  World world = EmptyWorld();
  AddPlainWall(world, {0, 0}, {x, 0});
  AddPlainWall(world, {x, 0}, {x, y});
  AddPlainWall(world, {x, y}, {0, y});
  AddPlainWall(world, {0, y}, {0, 0});
  return world;
}

/// The robot drives from (2, 2) along x in a room of 10 m by 4 m, without noise if `ideal` is asked
/// for in the simulation's options.
inline Scenario PlainScenario() {
  Scenario scenario;
  scenario.world = PlainRoom(10.0, 4.0);
  RobotPath path;
  path.start = {2.0, 2.0, 0.0};
  path.way_points = {{6.0, 2.0}};
  path.start_pause = 0.2;
  path.end_pause = 0.2;
  scenario.paths = {path};
  scenario.camera.width = 160;
  scenario.camera.height = 120;
  scenario.camera.centre_x = 0.0;
  scenario.camera.centre_y = 0.0;
  return scenario;
}

/// A distorted camera without noise and blur.
inline CameraSimulatorOptions SharpCamera() {
  CameraSimulatorOptions options = Ideal(CameraSimulatorOptions{});
  options.encoding = ImageEncoding::kMono8;
  options.k1 = -0.2;
  options.k2 = 0.06;
  options.p1 = 0.002;
  options.p2 = -0.001;
  return options;
}

/// A motion that has been constant since long before time 0.
inline MotionHistory ConstantMotion(const Pose2& at_zero, double speed, double turn_rate,
                                    double until = 1.0) {
  MotionHistory history(10.0);
  for (int i = -100; i <= static_cast<int>(until * 1000.0); ++i) {
    const double t = 0.001 * i;
    history.Add({FromSeconds(t), at_zero * Arc(speed * t, turn_rate * t), speed, turn_rate});
  }
  return history;
}

}  // namespace scan_image_slam
