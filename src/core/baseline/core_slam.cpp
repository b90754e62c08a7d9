#include "scan_image_slam/core/baseline/core_slam.h"

#include <cmath>
#include <stdexcept>
#include <utility>

namespace scan_image_slam {

void CoreSlamOptions::Validate() const {
  const auto require = [](bool ok, const char* what) {
    if (!ok) throw std::invalid_argument(what);
  };
  require(sigma_distance >= 0.0, "sigma_distance must not be negative");
  require(sigma_angle >= 0.0, "sigma_angle must not be negative");
  require(max_failures >= 0, "max_failures must not be negative");
  require(rays_per_beam >= 1, "rays_per_beam must be at least 1");
}

CoreSlamScan ToCoreSlamScan(const FusedModel& model, double min_range) {
  CoreSlamScan scan;
  scan.stamp = model.stamp;
  scan.origin = model.base_from_laser.translation();
  if (model.beams.size() > 1) {
    scan.beam_spacing = std::abs(model.beams.back().bearing - model.beams.front().bearing) /
                        static_cast<double>(model.beams.size() - 1);
  }
  for (const ModelBeam& beam : model.beams) {
    if (beam.hit() && beam.range > min_range) scan.hits.push_back(beam.point);
  }
  return scan;
}

CoreSlam::CoreSlam(const CoreSlamOptions& options, std::function<double()> normal)
    : options_((options.Validate(), options)),
      map_(options.cell_size, options.hole_width, options.quality),
      normal_(std::move(normal)) {}

Pose2 CoreSlam::Add(const CoreSlamScan& scan, const std::optional<Pose2>& odom_from_base) {
  if (drawn_stamp_) {
    Pose2 start = map_from_base_;
    if (last_odom_from_base_ && odom_from_base) {
      start = map_from_base_ * (last_odom_from_base_->Inverse() * *odom_from_base);
    }
    map_from_base_ = Search(scan, start);
  }
  last_odom_from_base_ = odom_from_base;
  if (!drawn_stamp_ || Seconds(scan.stamp - *drawn_stamp_) >= options_.update_period) {
    Draw(scan, map_from_base_);
    drawn_stamp_ = scan.stamp;
  }
  return map_from_base_;
}

double CoreSlam::Distance(const CoreSlamScan& scan, const Pose2& map_from_base) const {
  const Eigen::Vector2d corner = map_.ToCells(map_from_base.translation());
  const double c = std::cos(map_from_base.theta) / map_.cell_size();
  const double s = std::sin(map_from_base.theta) / map_.cell_size();
  std::int64_t sum = 0;
  for (const Eigen::Vector2d& hit : scan.hits) {
    // Truncation instead of floor: both agree inside the map, whose cells start at 0.
    sum += map_.AtCell(static_cast<int>(corner.x() + c * hit.x() - s * hit.y()),
                       static_cast<int>(corner.y() + s * hit.x() + c * hit.y()));
  }
  return scan.hits.empty() ? HoleMap::kFree
                           : static_cast<double>(sum) / static_cast<double>(scan.hits.size());
}

/// Tries around the best pose of the round before; a round ends, and the next one looks half as
/// far, when a third of the allowed tries has failed and something better was found.
Pose2 CoreSlam::Search(const CoreSlamScan& scan, const Pose2& start) {
  double sigma_distance = options_.sigma_distance;
  double sigma_angle = options_.sigma_angle;
  Pose2 centre = start;
  Pose2 best = start;
  double centre_distance = Distance(scan, start);
  double best_distance = centre_distance;
  tries_ = 0;
  for (int failures = 0; failures < options_.max_failures; ++tries_) {
    const Pose2 candidate{centre.x + sigma_distance * normal_(),
                          centre.y + sigma_distance * normal_(),
                          centre.theta + sigma_angle * normal_()};
    const double distance = Distance(scan, candidate);
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    } else {
      ++failures;
    }
    if (3 * failures > options_.max_failures && best_distance < centre_distance) {
      centre = best;
      centre_distance = best_distance;
      failures = 0;
      sigma_distance *= 0.5;
      sigma_angle *= 0.5;
    }
  }
  best.theta = NormalizeAngle(best.theta);
  return best;
}

void CoreSlam::Draw(const CoreSlamScan& scan, const Pose2& map_from_base) {
  const Eigen::Vector2d origin = map_from_base * scan.origin;
  for (const Eigen::Vector2d& hit : scan.hits) {
    const Eigen::Vector2d ray = hit - scan.origin;
    for (int i = 0; i < options_.rays_per_beam; ++i) {
      const double offset = (i - 0.5 * (options_.rays_per_beam - 1)) / options_.rays_per_beam;
      const Pose2 turn{0.0, 0.0, offset * scan.beam_spacing};
      map_.DrawRay(origin, map_from_base * Eigen::Vector2d(scan.origin + turn * ray));
    }
  }
}

}  // namespace scan_image_slam
