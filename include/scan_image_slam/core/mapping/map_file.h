#pragma once

#include "scan_image_slam/core/mapping/occupancy_grid.h"

#include <string>
#include <vector>

namespace scan_image_slam {

/// A grid as map_server stores it.
struct MapImage {
  int width = 0;                       ///< [cells]
  int height = 0;                      ///< [cells]
  double resolution = 0.05;            ///< [m]
  double origin_x = 0.0;               ///< of the lower left corner of the lower left cell [m]
  double origin_y = 0.0;               ///< [m]
  std::vector<std::int8_t> occupancy;  ///< -1 unknown, 0..100; row-major from the lower left
};

/// The part of a grid that is known, with a margin of one cell.
MapImage ToMapImage(const OccupancyGrid& grid);

/// Writes `stem`.pgm and `stem`.yaml as map_saver does: 254 free, 0 occupied, 205 unknown; an
/// empty map as one unknown cell, as there are no pictures without pixels. Returns the path of the
/// yaml. Throws std::runtime_error, naming the file, if one can't be written; neither is replaced
/// before both are written.
std::string WriteMap(const MapImage& map, const std::string& stem);

}  // namespace scan_image_slam
