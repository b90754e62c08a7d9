#pragma once

#include "scan_image_slam/core/simulation/lighting.h"
#include "scan_image_slam/core/simulation/person.h"

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace scan_image_slam {

/// Colour seen under light of brightness 1; components in [0, 255].
struct Colour {
  double red = 200.0;
  double green = 200.0;
  double blue = 200.0;
};

/// Fine structure of a surface. It only darkens, by a few per cent (brick and ceiling by more).
enum class Material { kPlain, kPlaster, kConcrete, kWood, kBrick, kCarpet, kTiles, kCeiling };

/// What the laser gets back from a wall.
enum class LaserReturn {
  kNormal,
  kDark,       ///< more noise, longer ranges, no return from afar
  kGlass,      ///< returns only when hit almost perpendicularly, else the beam goes through
  kInvisible,  ///< never returns; the beam goes through
};

/// A picture with structure inside, drawn from a seed.
struct PictureSpec {
  enum class Kind { kPoster, kNoticeBoard, kWindowView };
  Kind kind = Kind::kPoster;
  std::uint32_t seed = 0;
  bool operator==(const PictureSpec& other) const {
    return kind == other.kind && seed == other.seed;
  }
};

/// An upright rectangle painted on a face.
struct PaintedRectangle {
  double from = 0.0;    ///< along the face [m]
  double to = 0.0;      ///< [m]
  double bottom = 0.0;  ///< above the floor [m]
  double top = 0.0;     ///< [m]
  Colour colour;
  Material material = Material::kPlain;
  int picture = -1;  ///< index into World::pictures, which replaces the colour; -1 none
};

/// Rectangles that belong together (a door), painted in order, inside [from, to] along the face.
struct Decoration {
  double from = 0.0;  ///< [m]
  double to = 0.0;    ///< [m]
  std::vector<PaintedRectangle> rectangles;
};

/// What one side of a wall looks like. Several walls share a face if the wall has openings.
struct Face {
  Colour colour;
  Material material = Material::kPlain;
  std::vector<Decoration> decorations;  ///< painted in order
};

/// Upright rectangle above the line from `from` to `to`, seen and hit from both sides.
struct Wall {
  Eigen::Vector2d from{0, 0};  ///< in the world frame [m]
  Eigen::Vector2d to{0, 0};    ///< [m]
  double bottom = 0.0;         ///< above the floor [m]
  double top = 2.6;            ///< [m]
  int face = 0;                ///< index into World::faces
  double along_from = 0.0;     ///< where `from` lies on the face [m]
  LaserReturn laser = LaserReturn::kNormal;
};

/// Horizontal convex plate without thickness: a desk's top, a box's lid. Not seen by the laser.
struct Slab {
  std::vector<Eigen::Vector2d> corners;  ///< in order around, world frame [m]
  double height = 0.0;                   ///< above the floor [m]
  Colour colour;
};

/// Everything that the robot drives through. The floor is at height 0.
struct World {
  std::vector<Face> faces;
  std::vector<Wall> walls;
  std::vector<Slab> slabs;
  std::vector<PictureSpec> pictures;
  std::vector<Person> people;
  Lighting lighting;
  double ceiling_height = 2.6;  ///< [m]
  Face floor{{120, 116, 110}, Material::kCarpet, {}};
  Face ceiling{{225, 225, 220}, Material::kCeiling, {}};

  int AddFace(const Face& face);
  /// Adds a wall with a face of its own; returns the wall's index.
  int AddWall(const Wall& wall, const Face& face);
  /// Index of the picture, which is added if it is new.
  int AddPicture(const PictureSpec& picture);
};

/// Distance from `point` to the nearest wall that begins below `height` [m] and to the nearest
/// person at `time` [s since the start]; +Inf in an empty world.
double Clearance(const World& world, const Eigen::Vector2d& point, double height, double time);

}  // namespace scan_image_slam
