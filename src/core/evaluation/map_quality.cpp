#include "scan_image_slam/core/evaluation/map_quality.h"

#include "scan_image_slam/core/evaluation/key_values.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <utility>

namespace scan_image_slam {
namespace {

/// Where a point lies at a wall.
struct WallPlace {
  std::size_t wall = 0;
  double distance = std::numeric_limits<double>::infinity();  // to the nearest point of it [m]
  double across = 0.0;  // signed distance to its line, positive on the left of from -> to [m]
  double along = 0.0;   // from its beginning, may lie outside it [m]
};

WallPlace PlaceAt(const Eigen::Vector2d& point, const TrueWall& wall) {
  const Eigen::Vector2d edge = wall.to - wall.from;
  const double length = edge.norm();
  const Eigen::Vector2d direction = edge / length;
  const Eigen::Vector2d way = point - wall.from;
  WallPlace place;
  place.across = Across(direction).dot(way);
  place.along = direction.dot(way);
  const double beyond = place.along - std::clamp(place.along, 0.0, length);
  place.distance = std::hypot(place.across, beyond);
  return place;
}

WallPlace NearestWall(const Eigen::Vector2d& point, const std::vector<TrueWall>& walls) {
  WallPlace nearest;
  for (std::size_t i = 0; i < walls.size(); ++i) {
    WallPlace place = PlaceAt(point, walls[i]);
    place.wall = i;
    if (place.distance < nearest.distance) nearest = place;
  }
  return nearest;
}

/// The cells of a map in its frame.
class Cells {
 public:
  Cells(const MapImage& map, int occupied_from) : map_(map), occupied_from_(occupied_from) {}

  bool Occupied(int x, int y) const {
    if (x < 0 || x >= map_.width || y < 0 || y >= map_.height) return false;
    return map_.occupancy[static_cast<std::size_t>(y) * map_.width + x] >= occupied_from_;
  }

  Eigen::Vector2d Centre(int x, int y) const {
    return {map_.origin_x + (x + 0.5) * map_.resolution,
            map_.origin_y + (y + 0.5) * map_.resolution};
  }

  bool OccupiedWithin(const Eigen::Vector2d& point, double distance) const {
    const int reach = static_cast<int>(std::ceil(distance / map_.resolution));
    const int column = static_cast<int>(std::floor((point.x() - map_.origin_x) / map_.resolution));
    const int row = static_cast<int>(std::floor((point.y() - map_.origin_y) / map_.resolution));
    for (int y = row - reach; y <= row + reach; ++y) {
      for (int x = column - reach; x <= column + reach; ++x) {
        if (Occupied(x, y) && (Centre(x, y) - point).norm() <= distance) return true;
      }
    }
    return false;
  }

 private:
  const MapImage& map_;
  int occupied_from_;
};

/// Collects the cells of walls, section by section.
class WallCells {
 public:
  WallCells(const std::vector<TrueWall>& walls, const MapQualityOptions& options)
      : walls_(walls), options_(options) {}

  void Add(const WallPlace& place) {
    if (place.distance > options_.wall_distance) return;
    const double length = (walls_[place.wall].to - walls_[place.wall].from).norm();
    const bool beside = place.along >= 0.0 && place.along <= length;
    if (length < options_.min_wall_length || !beside) return;
    const int section = static_cast<int>(place.along / options_.wall_section);
    sections_[{place.wall, section}].push_back(place.across);
  }

  WallFit Fit() const {
    WallFit fit;
    double squares = 0.0;
    double central_squares = 0.0;
    for (const auto& [name, distances] : sections_) {
      double sum = 0.0;
      for (const double d : distances) sum += d;
      const double middle = sum / static_cast<double>(distances.size());
      for (const double d : distances) {
        squares += d * d;
        central_squares += (d - middle) * (d - middle);
      }
      fit.offset += std::abs(sum);
      fit.cells += distances.size();
    }
    const auto cells = static_cast<double>(fit.cells);
    fit.rms = std::sqrt(squares / cells);
    fit.thickness = std::sqrt(central_squares / cells);
    fit.offset /= cells;
    return fit;
  }

 private:
  const std::vector<TrueWall>& walls_;
  const MapQualityOptions& options_;
  std::map<std::pair<std::size_t, int>, std::vector<double>> sections_;
};

double Share(std::size_t part, std::size_t rest) {
  return static_cast<double>(part) / static_cast<double>(part + rest);
}

}  // namespace

void MapQualityOptions::Validate() const {
  const auto require = [](double value, const char* name) {
    if (!(std::isfinite(value) && value > 0.0)) {
      throw std::invalid_argument(std::string(name) + " must be finite and above 0");
    }
  };
  require(tolerance, "tolerance");
  require(wall_distance, "wall_distance");
  require(min_wall_length, "min_wall_length");
  require(wall_section, "wall_section");
  if (occupied_from < 1 || occupied_from > 100) {
    throw std::invalid_argument("occupied_from must be in 1 ... 100");
  }
}

double MapQuality::Precision() const { return Share(right_cells.size(), false_cells.size()); }

double MapQuality::Recall() const { return Share(seen - missed.size(), missed.size()); }

MapQuality EvaluateMap(const MapImage& map, const TruePlan& plan, const Pose2& world_from_map,
                       const MapQualityOptions& options) {
  options.Validate();
  const Cells cells(map, options.occupied_from);
  MapQuality quality;
  WallCells wall_cells(plan.walls, options);
  const RigidTransform2 to_world(world_from_map);
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) {
      if (!cells.Occupied(x, y)) continue;
      const WallPlace place = NearestWall(to_world * cells.Centre(x, y), plan.walls);
      const bool right = place.distance <= options.tolerance;
      (right ? quality.right_cells : quality.false_cells).emplace_back(x, y);
      wall_cells.Add(place);
    }
  }
  quality.walls = wall_cells.Fit();
  const RigidTransform2 to_map(world_from_map.Inverse());
  for (const Eigen::Vector2d& point : plan.seen) {
    const Eigen::Vector2d in_map = to_map * point;
    if (!cells.OccupiedWithin(in_map, options.tolerance)) quality.missed.push_back(in_map);
  }
  quality.seen = plan.seen.size();
  return quality;
}

std::string ToKeyValues(const MapQuality& quality) {
  KeyValues line;
  line.Add("occupied_cells", quality.right_cells.size() + quality.false_cells.size())
      .Add("precision_percent", 100.0 * quality.Precision())
      .Add("seen_points", quality.seen)
      .Add("recall_percent", 100.0 * quality.Recall())
      .Add("wall_cells", quality.walls.cells)
      .Add("wall_rms_m", quality.walls.rms)
      .Add("wall_thickness_m", quality.walls.thickness)
      .Add("wall_offset_m", quality.walls.offset);
  return line.Line();
}

}  // namespace scan_image_slam
