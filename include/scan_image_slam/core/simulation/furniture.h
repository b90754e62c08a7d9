#pragma once

#include "scan_image_slam/core/simulation/world.h"

#include <vector>

#include <Eigen/Geometry>

namespace scan_image_slam {

/// Place of a piece of furniture: its middle and the direction of its own x axis.
struct Placement {
  Eigen::Vector2d position{0, 0};  ///< [m]
  double yaw = 0.0;                ///< [rad]
};

std::vector<Eigen::Vector2d> RectangleOutline(const Placement& placement,
                                              const Eigen::Vector2d& size);
std::vector<Eigen::Vector2d> CircleOutline(const Eigen::Vector2d& centre, double radius,
                                           int corners);

/// Adds one wall per side of the outline; heights, face and laser come from `side`. The face runs
/// around the outline, beginning at its first corner.
void AppendPrism(const std::vector<Eigen::Vector2d>& outline, const Wall& side,
                 std::vector<Wall>& walls);

/// Everything below adds to the world. Looks are given by a face, heights are above the floor [m].

/// A closed body with a lid (and an underside, if it does not stand on the floor).
void AddBox(World& world, const Placement& placement, const Eigen::Vector2d& size, double bottom,
            double top, const Face& face, LaserReturn laser = LaserReturn::kNormal);

/// A round body of `corners` flat sides up to the ceiling or to `top`.
void AddPillar(World& world, const Eigen::Vector2d& centre, double radius, int corners, double top,
               const Face& face, LaserReturn laser = LaserReturn::kNormal);

/// A plate on four legs: at the height of a low laser only the legs are there.
void AddDesk(World& world, const Placement& placement, const Eigen::Vector2d& size, double height,
             double leg_width, const Face& top, const Face& legs);

/// Four legs, a seat and a back at negative x.
void AddChair(World& world, const Placement& placement, double width, const Face& face);

/// A box with doors, gaps and handles painted on its front, the side at negative y.
void AddCupboard(World& world, const Placement& placement, const Eigen::Vector2d& size,
                 double height, int doors, const Face& face);

}  // namespace scan_image_slam
