#include "scan_image_slam/core/mapping/mapper.h"

#include "scan_image_slam/core/geometry/covariance.h"

#include <cmath>
#include <stdexcept>

namespace scan_image_slam {
namespace {

GridScan ToGridScan(const FusedModel& model, const Velocity2& sweep_correction,
                    const OccupancyGridOptions& options) {
  GridScan scan;
  scan.origin = model.base_from_laser.translation();
  scan.beams.reserve(model.beams.size());
  for (const ModelBeam& beam : model.beams) {
    if (beam.hit() && beam.range <= options.max_range) {
      scan.beams.push_back({Move(sweep_correction, beam.time_offset) * beam.point, true});
      continue;
    }
    const bool far_hit = beam.hit();
    const bool clears =
        far_hit || options.no_return_policy == NoReturnPolicy::kClearToMaxLegacy ||
        (options.no_return_policy == NoReturnPolicy::kClearToMax && std::isinf(beam.range));
    if (!clears) continue;
    const double heading = model.HeadingOf(beam);
    const Velocity2 velocity = model.sweep_velocity + sweep_correction;
    const Eigen::Vector2d end =
        scan.origin + options.max_range * Eigen::Vector2d(std::cos(heading), std::sin(heading));
    scan.beams.push_back({Move(velocity, beam.time_offset) * end, false});
  }
  return scan;
}

}  // namespace

void MapperOptions::Validate() const {
  grid.Validate();
  const auto require = [](double value, const char* name) {
    if (!(std::isfinite(value) && value >= 0.0)) {
      throw std::invalid_argument(std::string(name) + " must be finite and not negative");
    }
  };
  require(map_update_distance_thresh, "map_update_distance_thresh");
  require(map_update_angle_thresh, "map_update_angle_thresh");
  require(map_update_time_thresh, "map_update_time_thresh");
}

Mapper::Mapper(const MapperOptions& options) : options_(options), grid_(options.grid) {
  options_.Validate();
}

void Mapper::BeginChain(const MatchedMotion& match) {
  if (start_stamp_ && match.start_stamp < last_.stamp) Reset();
  Pose2 map_from_base;
  if (!has_pose_) {
    if (match.odom_from_base) map_from_base = *match.odom_from_base;
  } else if (last_.map_from_odom && match.odom_from_base) {
    map_from_base = *last_.map_from_odom * *match.odom_from_base;
  } else {
    map_from_base = last_.map_from_base;
  }
  start_stamp_ = match.start_stamp;
  map_from_start_ = map_from_base * match.start_from_base().Inverse();
  start_covariance_ =
      TransportCovariance(last_.covariance, last_.map_from_base.Inverse() * map_from_start_);
}

MapPose Mapper::AddMatch(const MatchedMotion& match) {
  if (!start_stamp_ || match.start_stamp != *start_stamp_) BeginChain(match);
  last_.stamp = match.stamp;
  last_.map_from_base = map_from_start_ * match.start_from_base();
  last_.covariance =
      TransportCovariance(start_covariance_, match.start_from_base()) + match.covariance;
  last_.map_from_odom.reset();
  if (match.odom_from_base) {
    last_.map_from_odom = last_.map_from_base * match.odom_from_base->Inverse();
  }
  has_pose_ = true;
  return last_;
}

bool Mapper::WorthDrawing(const MatchedMotion& match, const Pose2& map_from_base) const {
  if (match.status == MatchStatus::kOnWindowEdge) return false;
  if (!drawn_stamp_) return true;
  const Pose2 moved = map_from_drawn_.Inverse() * map_from_base;
  return moved.translation().norm() >= options_.map_update_distance_thresh ||
         std::abs(moved.theta) >= options_.map_update_angle_thresh ||
         Seconds(match.stamp - *drawn_stamp_) >= options_.map_update_time_thresh;
}

void Mapper::AddModel(const FusedModel& model, const MatchedMotion& match) {
  const Pose2 map_from_base = map_from_start_ * match.start_from_base();
  if (!WorthDrawing(match, map_from_base)) return;
  grid_.Add(ToGridScan(model, match.sweep_correction, options_.grid), map_from_base);
  drawn_stamp_ = match.stamp;
  map_from_drawn_ = map_from_base;
}

void Mapper::SetPose(const Pose2& map_from_base) {
  const Pose2 new_from_old = map_from_base * last_.map_from_base.Inverse();
  map_from_start_ = new_from_old * map_from_start_;
  if (last_.map_from_odom) last_.map_from_odom = new_from_old * *last_.map_from_odom;
  last_.map_from_base = map_from_base;
  has_pose_ = true;
}

}  // namespace scan_image_slam
