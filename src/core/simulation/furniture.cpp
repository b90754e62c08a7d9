#include "scan_image_slam/core/simulation/furniture.h"

#include <algorithm>
#include <cmath>

namespace scan_image_slam {
namespace {

Eigen::Vector2d ToWorld(const Placement& placement, const Eigen::Vector2d& local) {
  return placement.position + Eigen::Rotation2Dd(placement.yaw) * local;
}

Colour Darker(const Colour& colour, double factor) {
  return {factor * colour.red, factor * colour.green, factor * colour.blue};
}

void AddSlab(World& world, const std::vector<Eigen::Vector2d>& corners, double height,
             const Colour& colour) {
  Slab slab;
  slab.corners = corners;
  slab.height = height;
  slab.colour = colour;
  world.slabs.push_back(slab);
}

/// Four posts just inside the corners of a rectangle.
void AddLegs(World& world, const Placement& placement, const Eigen::Vector2d& size, double width,
             double top, int face) {
  const Eigen::Vector2d inner = (size - Eigen::Vector2d::Constant(width)) / 2.0;
  for (const double x : {-inner.x(), inner.x()}) {
    for (const double y : {-inner.y(), inner.y()}) {
      Wall side;
      side.top = top;
      side.face = face;
      const Placement leg{ToWorld(placement, {x, y}), placement.yaw};
      AppendPrism(RectangleOutline(leg, {width, width}), side, world.walls);
    }
  }
}

/// Doors with dark gaps between them and a handle each, over [from, to] of a face.
Decoration CupboardFront(double from, double to, double height, int doors, const Colour& colour) {
  constexpr double kGap = 0.008;
  constexpr double kPlinth = 0.08;
  const Colour dark = Darker(colour, 0.3);
  Decoration front{from, to, {}};
  front.rectangles.push_back({from, to, 0.0, kPlinth, dark, Material::kPlain, -1});
  const double width = (to - from) / doors;
  for (int i = 1; i < doors; ++i) {
    const double gap = from + i * width;
    front.rectangles.push_back({gap - kGap / 2, gap + kGap / 2, kPlinth, height, dark});
  }
  for (int i = 0; i < doors; ++i) {
    // Handles of neighbouring doors meet at their common gap.
    const double handle = from + i * width + (i % 2 == 0 ? width - 0.05 : 0.03);
    front.rectangles.push_back({handle, handle + 0.02, 0.5 * height, 0.5 * height + 0.14, dark});
  }
  return front;
}

}  // namespace

std::vector<Eigen::Vector2d> RectangleOutline(const Placement& placement,
                                              const Eigen::Vector2d& size) {
  const Eigen::Vector2d h = size / 2.0;
  return {ToWorld(placement, {-h.x(), -h.y()}), ToWorld(placement, {h.x(), -h.y()}),
          ToWorld(placement, {h.x(), h.y()}), ToWorld(placement, {-h.x(), h.y()})};
}

std::vector<Eigen::Vector2d> CircleOutline(const Eigen::Vector2d& centre, double radius,
                                           int corners) {
  std::vector<Eigen::Vector2d> outline;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * M_PI * i / corners;
    outline.emplace_back(centre + radius * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  return outline;
}

void AppendPrism(const std::vector<Eigen::Vector2d>& outline, const Wall& side,
                 std::vector<Wall>& walls) {
  double along = 0.0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    Wall wall = side;
    wall.from = outline[i];
    wall.to = outline[(i + 1) % outline.size()];
    wall.along_from = along;
    along += (wall.to - wall.from).norm();
    walls.push_back(wall);
  }
}

void AddBox(World& world, const Placement& placement, const Eigen::Vector2d& size, double bottom,
            double top, const Face& face, LaserReturn laser) {
  const std::vector<Eigen::Vector2d> outline = RectangleOutline(placement, size);
  Wall side;
  side.bottom = bottom;
  side.top = top;
  side.laser = laser;
  side.face = world.AddFace(face);
  AppendPrism(outline, side, world.walls);
  AddSlab(world, outline, top, face.colour);
  if (bottom > 0.0) AddSlab(world, outline, bottom, Darker(face.colour, 0.5));
}

void AddPillar(World& world, const Eigen::Vector2d& centre, double radius, int corners, double top,
               const Face& face, LaserReturn laser) {
  Wall side;
  side.top = top;
  side.laser = laser;
  side.face = world.AddFace(face);
  const std::vector<Eigen::Vector2d> outline = CircleOutline(centre, radius, corners);
  AppendPrism(outline, side, world.walls);
  if (top < world.ceiling_height) AddSlab(world, outline, top, face.colour);
}

void AddDesk(World& world, const Placement& placement, const Eigen::Vector2d& size, double height,
             double leg_width, const Face& top, const Face& legs) {
  constexpr double kThickness = 0.03;
  AddLegs(world, placement, size, leg_width, height - kThickness, world.AddFace(legs));
  AddBox(world, placement, size, height - kThickness, height, top);
}

void AddChair(World& world, const Placement& placement, double width, const Face& face) {
  constexpr double kSeat = 0.45;
  constexpr double kLeg = 0.03;
  constexpr double kBack = 0.04;
  Face steel;
  steel.colour = {70, 70, 72};
  AddLegs(world, placement, {width, width}, kLeg, kSeat - 0.04, world.AddFace(steel));
  AddBox(world, placement, {width, width}, kSeat - 0.04, kSeat, face);
  const Placement back{ToWorld(placement, {(kBack - width) / 2.0, 0.0}), placement.yaw};
  AddBox(world, back, {kBack, width}, kSeat + 0.1, 0.88, face);
}

void AddCupboard(World& world, const Placement& placement, const Eigen::Vector2d& size,
                 double height, int doors, const Face& face) {
  Face front = face;  // the outline begins with the side at negative y
  front.decorations.push_back(CupboardFront(0.0, size.x(), height, doors, face.colour));
  AddBox(world, placement, size, 0.0, height, front);
}

}  // namespace scan_image_slam
