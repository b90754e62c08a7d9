#pragma once

#include "scan_image_slam/core/simulation/bearing_grid.h"
#include "scan_image_slam/core/simulation/world.h"

#include <vector>

#include <Eigen/Geometry>

namespace scan_image_slam {

/// Where a levelled camera is, and in which light.
struct SceneView {
  Eigen::Vector2d position{0, 0};  ///< in the world frame [m]
  double heading = 0.0;            ///< direction of bearing 0, world frame [rad]
  double height = 0.0;             ///< above the floor [m]
  Eigen::Vector2d robot{0, 0};     ///< whose shadow is seen [m]
  double time = 0.0;               ///< since the start of the simulation [s]
  double light = 1.0;              ///< factor on all brightness
  double slope_shift = 0.0;        ///< added to all slopes of the grid, from a small nod [m/m]
};

/// A blurred bright or dark spot on a wall that moves with the viewer: where along it, at what
/// height, how large (standard deviations) and how strong (0 to 1).
struct Spot {
  double along = 0.0;         ///< on the face [m]
  double sigma_along = 0.1;   ///< [m]
  double height = 0.0;        ///< [m]
  double sigma_height = 0.5;  ///< [m]
  double strength = 0.0;
  bool bright = true;
};

/// A wall in the frame of the view. The ray (cos b, sin b) meets it at the horizontal distance
/// d = offset / (normal . ray), at d (edge . ray) + along on its face.
struct ViewedWall {
  Eigen::Vector2d normal;
  Eigen::Vector2d edge;
  double offset = 0.0;
  double along = 0.0;
  double bottom = 0.0;
  double top = 0.0;
  int face = 0;
  double shade = 1.0;   ///< from the direction of the light
  bool closes = false;  ///< reaches from floor to ceiling: nothing behind it is seen
  std::vector<Spot> spots;
};

struct ViewedSlab {
  std::vector<Eigen::Vector2d> corners;  ///< in the frame of the view
  double height = 0.0;
  Colour colour;
};

/// The part of a column of the grid in which something is seen (if nothing hides it).
struct Fragment {
  int wall = -1;       ///< index into ViewedScene::walls, or -1
  int slab = -1;       ///< index into ViewedScene::slabs, or -1
  float begin = 0.0F;  ///< fraction of the column, 0 its first border
  float end = 1.0F;
};

/// What can be seen from one place, sorted into the columns of a grid.
struct ViewedScene {
  std::vector<ViewedWall> walls;
  std::vector<ViewedSlab> slabs;
  std::vector<std::vector<Fragment>> columns;
};

/// Walls, slabs and people of the world as seen at this moment.
ViewedScene MakeViewedScene(const World& world, const SceneView& view, const BearingGrid& grid);

}  // namespace scan_image_slam
