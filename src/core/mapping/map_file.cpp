#include "scan_image_slam/core/mapping/map_file.h"

#include "scan_image_slam/core/mapping/atomic_file.h"

#include <iomanip>
#include <sstream>

namespace scan_image_slam {
namespace {

// As map_saver: cells at least so probably occupied are walls, at most so probably are free.
constexpr int kOccupied = 65;
constexpr int kFree = 25;

std::uint8_t Grey(std::int8_t occupancy) {
  if (occupancy < 0) return 205;
  if (occupancy >= kOccupied) return 0;
  return occupancy <= kFree ? 254 : 205;
}

/// A single-quoted scalar of YAML, which may hold any printable character.
std::string Quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? "''" : std::string(1, c);
  return quoted + "'";
}

}  // namespace

MapImage ToMapImage(const OccupancyGrid& grid) {
  const CellBox& box = grid.box();
  CellBox known{{box.x.end, box.x.begin}, {box.y.end, box.y.begin}};
  for (int y = box.y.begin; y < box.y.end; ++y) {
    for (int x = box.x.begin; x < box.x.end; ++x) {
      if (grid.Occupancy(x, y) < 0) continue;
      known.x = {std::min(known.x.begin, x), std::max(known.x.end, x + 1)};
      known.y = {std::min(known.y.begin, y), std::max(known.y.end, y + 1)};
    }
  }
  MapImage map;
  map.resolution = grid.resolution();
  if (known.empty()) return map;
  known = {{known.x.begin - 1, known.x.end + 1}, {known.y.begin - 1, known.y.end + 1}};
  map.width = known.x.size();
  map.height = known.y.size();
  map.origin_x = known.x.begin * map.resolution;
  map.origin_y = known.y.begin * map.resolution;
  map.occupancy.reserve(static_cast<std::size_t>(map.width) * map.height);
  for (int y = known.y.begin; y < known.y.end; ++y) {
    for (int x = known.x.begin; x < known.x.end; ++x) map.occupancy.push_back(grid.Occupancy(x, y));
  }
  return map;
}

std::string WriteMap(const MapImage& map, const std::string& stem) {
  if (map.occupancy.empty()) {
    MapImage unknown = map;
    unknown.width = 1;
    unknown.height = 1;
    unknown.occupancy = {-1};
    return WriteMap(unknown, stem);
  }
  std::string pixels;
  pixels.reserve(map.occupancy.size());
  for (int row = map.height - 1; row >= 0; --row) {  // pictures start at the top
    for (int x = 0; x < map.width; ++x) {
      pixels.push_back(
          static_cast<char>(Grey(map.occupancy[static_cast<std::size_t>(row) * map.width + x])));
    }
  }
  const std::string header =
      "P5\n" + std::to_string(map.width) + " " + std::to_string(map.height) + "\n255\n";
  std::ostringstream yaml;
  yaml.imbue(std::locale::classic());
  yaml << std::setprecision(10);
  const std::string name = stem.substr(stem.find_last_of('/') + 1);
  yaml << "image: " << Quoted(name + ".pgm") << "\nresolution: " << map.resolution << "\norigin: ["
       << map.origin_x << ", " << map.origin_y << ", 0.0]\nnegate: 0\noccupied_thresh: 0.65\n"
       << "free_thresh: 0.196\n";
  ReplaceFiles({{stem + ".pgm", header + pixels}, {stem + ".yaml", yaml.str()}});
  return stem + ".yaml";
}

}  // namespace scan_image_slam
