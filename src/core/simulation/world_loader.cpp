#include "scan_image_slam/core/simulation/world_loader.h"

#include "object_loader.h"
#include "yaml_values.h"

#include <cmath>
#include <stdexcept>

namespace scan_image_slam {
namespace {

DoorLook ReadOpeningLook(YamlSection& section) {
  DoorLook look;
  look.leaf = ReadColour(section, "colour", look.leaf);
  look.trim = ReadColour(section, "frame_colour", look.trim);
  return look;
}

WallOpening ReadOpening(YamlSection section, double at) {
  WallOpening opening;
  opening.at = at;
  opening.width = section.Number("width", 0.1, kMaxLength, opening.width);
  opening.height = section.Number("height", 0.1, kMaxHeight, opening.height);
  opening.door = section.Flag("door", opening.door);
  opening.recess = section.Number("recess", 0.0, 5.0, opening.recess);
  opening.look = ReadOpeningLook(section);
  section.Done();
  return opening;
}

WallPlan ReadWallPlan(YamlSection& section, const World& world, const std::string& default_id) {
  WallPlan plan;
  plan.id = section.Text("id", default_id);
  plan.bottom = section.Number("bottom", 0.0, kMaxHeight, 0.0);
  plan.top = section.Number("top", 0.0, kMaxHeight, world.ceiling_height);
  if (plan.top <= plan.bottom) section.Fail("top", "must be above the bottom");
  plan.thickness = section.Number("thickness", 0.0, 10.0, 0.0);
  plan.face = ReadFace(section, {{214, 211, 203}, Material::kPlaster, {}});
  plan.skirting = section.Number("skirting", 0.0, 1.0, 0.0);
  plan.skirting_colour = ReadColour(section, "skirting_colour", plan.skirting_colour);
  plan.laser = ReadLaserReturn(section);
  for (YamlSection opening : section.Children("openings")) {
    for (const double at : opening.NumberOrNumbers("at", 0.0, kMaxLength)) {
      plan.openings.push_back(ReadOpening(opening, at));
    }
  }
  return plan;
}

std::vector<Eigen::Vector2d> ReadCorners(YamlSection& section) {
  if (!section.Has("points")) return {section.Point("from"), section.Point("to")};
  std::vector<Eigen::Vector2d> corners;
  for (const std::vector<double>& row : section.Table("points", 2, -1e4, 1e4)) {
    corners.emplace_back(row[0], row[1]);
  }
  if (corners.size() < 2) section.Fail("points", "needs at least two points");
  if (section.Flag("closed", false)) corners.push_back(corners.front());
  return corners;
}

/// One wall from `from` to `to`, or one for each side of `points`, named `id.0`, `id.1` ...
void ReadWall(YamlSection& section, World& world, NamedFaces& names) {
  WallPlan plan = ReadWallPlan(section, world, "wall" + std::to_string(names.size()));
  const bool several = section.Has("points");
  const std::vector<Eigen::Vector2d> corners = ReadCorners(section);
  const std::vector<Eigen::Vector2d> offsets = ReadRepeat(section);
  section.Done();
  const std::string id = plan.id;
  if (names.count(id) + names.count(id + ".0") + names.count(id + ".left") > 0) {
    section.Fail("id", "'" + id + "' is used already");
  }
  for (std::size_t k = 0; k < offsets.size(); ++k) {
    for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
      plan.id =
          id + (k > 0 ? "#" + std::to_string(k) : "") + (several ? "." + std::to_string(i) : "");
      plan.from = corners[i] + offsets[k];
      plan.to = corners[i + 1] + offsets[k];
      try {
        AddWallPlan(world, plan, names);
      } catch (const std::invalid_argument& error) {
        section.Fail("", error.what());
      }
    }
  }
}

void ReadPerson(YamlSection& section, World& world) {
  Person person;
  for (const std::vector<double>& row : section.Table("path", 3, -1e4, 1e4)) {
    if (!person.path.empty() && row[2] <= person.path.back().time) {
      section.Fail("path", "must have increasing times");
    }
    person.path.push_back({{row[0], row[1]}, row[2]});
  }
  if (person.path.empty()) section.Fail("path", "needs at least one way point [x, y, time]");
  person.loop = section.Flag("loop", false);
  person.height = section.Number("height", 0.8, 2.3, person.height);
  Face trousers{ReadColour(section, "trousers", {52, 58, 82}), Material::kPlain, {}};
  Face shirt{ReadColour(section, "shirt", {150, 60, 55}), Material::kPlain, {}};
  const int stripes = section.Integer("stripes", 0, 50, 0);
  if (stripes > 0)
    shirt.decorations.push_back(MakeSlats(0.68, 1.36, 0.0, 3.0, stripes, shirt.colour));
  section.Done();
  person.trousers = world.AddFace(trousers);
  person.shirt = world.AddFace(shirt);
  person.head = world.AddFace({{196, 156, 132}, Material::kPlain, {}});
  world.people.push_back(person);
}

LightRegion ReadRegion(YamlSection& section) {
  LightRegion region;
  region.low = section.Point("low");
  region.high = section.Point("high");
  if ((region.high - region.low).minCoeff() <= 0.0) section.Fail("high", "must exceed low");
  region.brightness = section.Number("brightness", 0.0, 20.0, region.brightness);
  region.border = section.Number("border", 0.0, 100.0, region.border);
  region.blur = section.Number("blur_px", 0.0, 20.0, region.blur);
  section.Done();
  return region;
}

void ReadLighting(YamlSection section, Lighting& lighting) {
  lighting.brightness = section.Number("brightness", 0.0, 20.0, lighting.brightness);
  lighting.flicker = section.Number("flicker", 0.0, 1.0, lighting.flicker);
  lighting.flicker_frequency =
      section.Number("flicker_frequency", 0.01, 1000.0, lighting.flicker_frequency);
  lighting.highlights = section.Number("highlights", 0.0, 1.0, lighting.highlights);
  lighting.shadows = section.Number("shadows", 0.0, 1.0, lighting.shadows);
  for (YamlSection& region : section.Children("regions")) {
    lighting.regions.push_back(ReadRegion(region));
  }
  for (YamlSection& item : section.Children("lamps")) {
    Lamp lamp;
    const Eigen::Vector2d at = item.Point("at");
    lamp.height = item.Number("height", 0.5, kMaxHeight, lamp.height);
    for (const Eigen::Vector2d& offset : ReadRepeat(item)) {
      lamp.position = at + offset;
      lighting.lamps.push_back(lamp);
    }
    item.Done();
  }
  section.Done();
}

Face ReadPlane(YamlSection section, const Face& fallback) {
  Face face = ReadFace(section, fallback);
  section.Done();
  return face;
}

}  // namespace

void ReadWorld(YamlSection& root, World& world, NamedFaces& names) {
  world.ceiling_height = root.Number("ceiling_height", 1.0, kMaxHeight, world.ceiling_height);
  world.floor = ReadPlane(root.Child("floor"), world.floor);
  world.ceiling = ReadPlane(root.Child("ceiling"), world.ceiling);
  for (YamlSection& wall : root.Children("walls")) ReadWall(wall, world, names);
  for (YamlSection& object : root.Children("objects")) ReadObject(object, world);
  for (YamlSection& item : root.Children("decorations")) ReadDecoration(item, world, names);
  for (YamlSection& person : root.Children("people")) ReadPerson(person, world);
  ReadLighting(root.Child("lighting"), world.lighting);
}

}  // namespace scan_image_slam
