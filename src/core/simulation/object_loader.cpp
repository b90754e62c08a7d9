#include "object_loader.h"

#include "scan_image_slam/core/simulation/furniture.h"
#include "scan_image_slam/core/simulation/random_stream.h"
#include "yaml_values.h"

#include <cmath>

namespace scan_image_slam {
namespace {

double Radians(double degrees) { return degrees * M_PI / 180.0; }

/// `places: [[x, y, yaw_deg], ...]`, or `at: [x, y]` with `yaw_deg`; all of them repeated.
std::vector<Placement> ReadPlacements(YamlSection& section) {
  std::vector<Placement> once;
  if (section.Has("places")) {
    for (const std::vector<double>& row : section.Table("places", 3, -1e4, 1e4)) {
      once.push_back({{row[0], row[1]}, Radians(row[2])});
    }
  } else {
    const Eigen::Vector2d at = section.Point("at");
    once.push_back({at, Radians(section.Number("yaw_deg", -360.0, 360.0, 0.0))});
  }
  std::vector<Placement> placements;
  for (const Eigen::Vector2d& offset : ReadRepeat(section)) {
    for (const Placement& placement : once) {
      placements.push_back({placement.position + offset, placement.yaw});
    }
  }
  return placements;
}

Eigen::Vector2d ReadSize(YamlSection& section, const Eigen::Vector2d& fallback) {
  Eigen::Vector2d size = section.Point("size", fallback);
  if (size.minCoeff() <= 0.0) section.Fail("size", "must be positive");
  return size;
}

void ReadBox(YamlSection& section, World& world) {
  const Eigen::Vector2d size = ReadSize(section, {0.4, 0.4});
  const double bottom = section.Number("bottom", 0.0, kMaxHeight, 0.0);
  const double top = section.Number("height", 0.0, kMaxHeight, 0.4);
  if (top <= bottom) section.Fail("height", "must be above the bottom");
  const Face face = ReadFace(section, {{150, 118, 82}, Material::kPlain, {}});
  const LaserReturn laser = ReadLaserReturn(section);
  for (const Placement& placement : ReadPlacements(section)) {
    AddBox(world, placement, size, bottom, top, face, laser);
  }
}

void ReadDesk(YamlSection& section, World& world) {
  const Eigen::Vector2d size = ReadSize(section, {1.6, 0.8});
  const double height = section.Number("height", 0.2, 2.0, 0.75);
  const double leg = section.Number("leg_width", 0.01, 0.3, 0.05);
  const Face top = ReadFace(section, {{186, 160, 122}, Material::kWood, {}});
  const Face legs{ReadColour(section, "leg_colour", {120, 122, 125}), Material::kPlain, {}};
  for (const Placement& placement : ReadPlacements(section)) {
    AddDesk(world, placement, size, height, leg, top, legs);
  }
}

void ReadChair(YamlSection& section, World& world) {
  const double width = section.Number("width", 0.2, 1.0, 0.44);
  const Face face = ReadFace(section, {{58, 72, 104}, Material::kPlain, {}});
  for (const Placement& placement : ReadPlacements(section))
    AddChair(world, placement, width, face);
}

void ReadCupboard(YamlSection& section, World& world) {
  const Eigen::Vector2d size = ReadSize(section, {0.9, 0.45});
  const double height = section.Number("height", 0.3, kMaxHeight, 1.9);
  const int doors = section.Integer("doors", 1, 20, 2);
  const Face face = ReadFace(section, {{168, 170, 172}, Material::kPlain, {}});
  for (const Placement& placement : ReadPlacements(section)) {
    AddCupboard(world, placement, size, height, doors, face);
  }
}

void ReadPillar(YamlSection& section, World& world) {
  const double radius = section.Number("radius", 0.02, 5.0, 0.25);
  const int corners = section.Integer("corners", 3, 64, 16);
  const double top = section.Number("height", 0.1, kMaxHeight, world.ceiling_height);
  const Face face = ReadFace(section, {{190, 188, 182}, Material::kConcrete, {}});
  const LaserReturn laser = ReadLaserReturn(section);
  for (const Placement& placement : ReadPlacements(section)) {
    AddPillar(world, placement.position, radius, corners, top, face, laser);
  }
}

/// `count` boxes of random size, place and colour inside [low, high].
void ReadClutter(YamlSection& section, World& world) {
  const Eigen::Vector2d low = section.Point("low");
  const Eigen::Vector2d high = section.Point("high");
  const int count = section.Integer("count", 1, 1000);
  const int seed = section.Integer("seed", 0, 1000000, 0);
  const double smallest = section.Number("smallest", 0.02, 5.0, 0.15);
  const double largest = section.Number("largest", smallest, 5.0, 0.5);
  const double tallest = section.Number("tallest", 0.05, kMaxHeight, 1.0);
  const Eigen::Vector2d room = (high - low).array() - largest * M_SQRT2;
  if (room.minCoeff() < 0.0) section.Fail("high", "leaves no room for the largest box");
  RandomStream random(seed, "clutter");
  for (int i = 0; i < count; ++i) {
    const double width = random.Uniform(smallest, largest);
    const double depth = random.Uniform(smallest, largest);
    const double height = random.Uniform(0.3 * tallest, tallest);
    const double along = random.Uniform();
    const double across = random.Uniform();
    const Placement placement{low + room.cwiseProduct(Eigen::Vector2d(along, across)) +
                                  Eigen::Vector2d::Constant(largest * M_SQRT1_2),
                              random.Uniform(0.0, 2.0 * M_PI)};
    const double shade = random.Uniform(60.0, 190.0);
    const double warm = random.Uniform(0.7, 1.0);
    AddBox(world, placement, {width, depth}, 0.0, height,
           {{shade, warm * shade, warm * warm * shade}, Material::kPlain, {}});
  }
}

}  // namespace

void ReadObject(YamlSection& section, World& world) {
  using Reader = void (*)(YamlSection&, World&);
  static const std::vector<std::string> kShapes = {"box",      "desk",   "chair",
                                                   "cupboard", "pillar", "clutter"};
  static const std::vector<Reader> kReaders = {ReadBox,      ReadDesk,   ReadChair,
                                               ReadCupboard, ReadPillar, ReadClutter};
  section.Text("shape");
  kReaders[section.Choice("shape", kShapes, 0)](section, world);
  section.Done();
}

}  // namespace scan_image_slam
