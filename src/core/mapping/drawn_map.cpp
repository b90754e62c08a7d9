#include "scan_image_slam/core/mapping/drawn_map.h"

#include <cmath>
#include <utility>

namespace scan_image_slam {

DrawnMap::DrawnMap(const OccupancyGridOptions& options, int max_scans_per_place)
    : grid_(options), max_scans_per_place_(max_scans_per_place) {}

void DrawnMap::SetOptions(const OccupancyGridOptions& options, int max_scans_per_place) {
  grid_.SetOptions(options);
  max_scans_per_place_ = max_scans_per_place;
}

DrawnMap::Place DrawnMap::PlaceOf(const Pose2& map_from_base) {
  constexpr double kSide = 0.5;           // [m]
  constexpr double kSector = M_PI / 4.0;  // [rad]
  return {static_cast<int>(std::floor(map_from_base.x / kSide)),
          static_cast<int>(std::floor(map_from_base.y / kSide)),
          static_cast<int>(std::floor(NormalizeAngle(map_from_base.theta) / kSector))};
}

void DrawnMap::Keep(DrawnScan scan) {
  places_[PlaceOf(scan.map_from_base)].insert(next_);
  scans_.emplace_hint(scans_.end(), next_, std::move(scan));
  ++next_;
}

void DrawnMap::Add(DrawnScan scan) {
  grid_.Add(*scan.scan, scan.map_from_base);
  std::set<int>& here = places_[PlaceOf(scan.map_from_base)];
  while (static_cast<int>(here.size()) >= max_scans_per_place_) {
    const auto oldest = scans_.find(*here.begin());
    grid_.Remove(*oldest->second.scan, oldest->second.map_from_base);
    scans_.erase(oldest);
    here.erase(here.begin());
  }
  Keep(std::move(scan));
}

void DrawnMap::Load(const std::vector<DrawnScan>& scans) {
  for (const DrawnScan& scan : scans) {
    grid_.Add(*scan.scan, scan.map_from_base);
    Keep(scan);
  }
}

void DrawnMap::Reattach(const Anchors& let_go) {
  for (auto& [number, drawn] : scans_) drawn.pose = Reattached(drawn.pose, let_go);
}

bool DrawnMap::Redraw(const GraphPoses& keyframe_poses, int max_scans) {
  constexpr double kCells = 0.2;
  constexpr double kAngle = 0.002;  // [rad]
  auto end = scans_.lower_bound(to_redraw_);
  while (end != scans_.begin() && max_scans > 0) {
    auto& [number, drawn] = *--end;
    to_redraw_ = number;
    const Pose2 map_from_base = MapFromBase(drawn.pose, keyframe_poses);
    const Pose2 moved = drawn.map_from_base.Inverse() * map_from_base;
    if (moved.translation().norm() < kCells * grid_.resolution() &&
        std::abs(moved.theta) < kAngle) {
      continue;
    }
    grid_.Add(*drawn.scan, map_from_base);
    grid_.Remove(*drawn.scan, drawn.map_from_base);
    places_[PlaceOf(drawn.map_from_base)].erase(number);
    places_[PlaceOf(map_from_base)].insert(number);
    drawn.map_from_base = map_from_base;
    --max_scans;
  }
  return end == scans_.begin();
}

std::vector<DrawnScan> DrawnMap::scans() const {
  std::vector<DrawnScan> scans;
  scans.reserve(scans_.size());
  for (const auto& [number, scan] : scans_) scans.push_back(scan);
  return scans;
}

}  // namespace scan_image_slam
