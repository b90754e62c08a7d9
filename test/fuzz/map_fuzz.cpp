// Any map of map_server, its yaml up to the first zero byte and its picture behind it: refused, or
// each cell is occupied, free or unknown.

#include "fuzz_file.h"
#include "scan_image_slam/core/mapping/map_reader.h"

#include <algorithm>
#include <stdexcept>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace scan_image_slam;
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  const std::size_t zero = std::min(bytes.find('\0'), size);
  const std::size_t behind = std::min(zero + 1, size);
  const FuzzFile picture(data + behind, size - behind);
  const std::string yaml = "image: " + picture.path() + "\n" + bytes.substr(0, zero);
  const FuzzFile file(reinterpret_cast<const std::uint8_t*>(yaml.data()), yaml.size());
  try {
    const MapImage map = ReadMap(file.path());
    const auto cells = static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height);
    Require(map.occupancy.size() == cells && map.resolution > 0.0);
    for (const int cell : map.occupancy) Require(cell == 100 || cell == 0 || cell == -1);
  } catch (const std::runtime_error&) {
  }
  return 0;
}
