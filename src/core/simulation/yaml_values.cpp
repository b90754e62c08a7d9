#include "yaml_values.h"

namespace scan_image_slam {

Colour ReadColour(YamlSection& section, const std::string& key, const Colour& fallback) {
  if (!section.Has(key)) return fallback;
  const std::vector<double> values = section.Numbers(key, 3, 0.0, 255.0);
  return {values[0], values[1], values[2]};
}

Face ReadFace(YamlSection& section, const Face& fallback) {
  static const std::vector<std::string> kNames = {"plain", "plaster", "concrete", "wood",
                                                  "brick", "carpet",  "tiles",    "ceiling"};
  Face face = fallback;
  face.colour = ReadColour(section, "colour", fallback.colour);
  face.material = static_cast<Material>(
      section.Choice("material", kNames, static_cast<std::size_t>(fallback.material)));
  return face;
}

LaserReturn ReadLaserReturn(YamlSection& section) {
  static const std::vector<std::string> kNames = {"normal", "dark", "glass", "invisible"};
  return static_cast<LaserReturn>(section.Choice("laser", kNames, 0));
}

std::vector<Eigen::Vector2d> ReadRepeat(YamlSection& section) {
  std::vector<Eigen::Vector2d> offsets = {{0.0, 0.0}};
  if (!section.Has("repeat")) return offsets;
  YamlSection repeat = section.Child("repeat");
  const int count = repeat.Integer("count", 1, 10000);
  const Eigen::Vector2d step = repeat.Point("step");
  repeat.Done();
  for (int i = 1; i < count; ++i) offsets.emplace_back(i * step);
  return offsets;
}

}  // namespace scan_image_slam
