#pragma once

#include "scan_image_slam/core/simulation/decorations.h"
#include "scan_image_slam/core/simulation/world.h"

#include <map>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace scan_image_slam {

/// A gap in a wall: a passage, or a door that is set back.
struct WallOpening {
  double at = 0.0;       ///< middle, along the wall [m]
  double width = 1.0;    ///< [m]
  double height = 2.05;  ///< [m]
  bool door = false;     ///< closed by a door leaf
  double recess = 0.12;  ///< how far the leaf is set back, to the right of a thin wall [m]
  DoorLook look;
};

/// A straight wall as an architect draws it.
struct WallPlan {
  std::string id;
  Eigen::Vector2d from{0, 0};  ///< [m]
  Eigen::Vector2d to{0, 0};    ///< [m]
  double bottom = 0.0;         ///< [m]
  double top = 2.6;            ///< [m]
  double thickness = 0.0;      ///< 0: one face; else a left and a right one [m]
  Face face;
  double skirting = 0.0;  ///< height of the skirting board, 0 none [m]
  Colour skirting_colour{96, 86, 78};
  LaserReturn laser = LaserReturn::kNormal;
  std::vector<WallOpening> openings;
};

/// Where decorations can be put: face and its length [m].
struct NamedFace {
  int face = 0;
  double length = 0.0;
};
using NamedFaces = std::map<std::string, NamedFace>;

/// Adds the walls that the plan stands for. The faces are named `id`, or `id.left` and `id.right`
/// (seen along the wall) if the wall is thick; both count `along` from `from`.
/// Throws std::invalid_argument if an opening does not fit.
void AddWallPlan(World& world, const WallPlan& plan, NamedFaces& names);

}  // namespace scan_image_slam
