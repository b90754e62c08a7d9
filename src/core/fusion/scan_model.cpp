#include "scan_image_slam/core/fusion/scan_model.h"

#include <cmath>
#include <limits>
#include <stdexcept>

namespace scan_image_slam {
namespace {

double CodedRange(double range, const LaserScan& scan, const ScanModelOptions& options) {
  switch (Classify(range, scan.range_min, scan.range_max)) {
    case BeamReturn::kHit:
      if (range < options.min_range || range > options.max_range) break;
      return range;
    case BeamReturn::kNoObject:
      return std::numeric_limits<double>::infinity();
    case BeamReturn::kUnknown:
      break;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

void ScanModelOptions::Validate() const {
  const auto require = [](bool ok, const char* what) {
    if (!ok) throw std::invalid_argument(what);
  };
  require(min_range >= 0.0, "min_range must not be negative");
  require(max_range > min_range, "max_range must be greater than min_range");
  require(field_of_view > 0.0, "field_of_view must be positive");
  require(min_beam_spacing >= 0.0, "min_beam_spacing must not be negative");
}

LaserMount LaserMount::From(const Eigen::Isometry3d& base_from_laser) {
  const Eigen::Matrix3d& rotation = base_from_laser.linear();
  const double up = rotation(2, 2);
  constexpr double kMaxTilt = 2.0 * M_PI / 180.0;
  if (std::abs(up) < std::cos(kMaxTilt)) {
    throw std::invalid_argument(
        "the laser is tilted by " + std::to_string(std::acos(std::abs(up)) * 180.0 / M_PI) +
        " degrees: it must scan a horizontal plane (roll 0 or 180 degrees)");
  }
  LaserMount mount;
  mount.upside_down = up < 0.0;
  mount.height = base_from_laser.translation().z();
  mount.base_from_laser = {base_from_laser.translation().x(), base_from_laser.translation().y(),
                           std::atan2(rotation(1, 0), rotation(0, 0))};
  return mount;
}

FusedModel MakeScanModel(const LaserScan& scan, const LaserMount& mount,
                         const Velocity2& base_velocity, const ScanModelOptions& options) {
  FusedModel model;
  model.stamp = scan.stamp;
  model.base_from_laser = mount.base_from_laser;
  model.upside_down = mount.upside_down;
  model.sweep_velocity = base_velocity;
  model.beams.reserve(scan.ranges.size());
  const double min_spacing = options.min_beam_spacing * (1.0 - 1e-6);
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    ModelBeam beam;
    beam.bearing = scan.Bearing(i);
    const double heading = model.HeadingOf(beam);
    if (2.0 * std::abs(NormalizeAngle(heading)) > options.field_of_view) continue;
    if (!model.beams.empty() && std::abs(beam.bearing - model.beams.back().bearing) < min_spacing) {
      continue;
    }
    beam.range = CodedRange(scan.ranges[i], scan, options);
    beam.time_offset = static_cast<double>(i) * scan.time_increment;
    if (beam.hit()) {
      const Eigen::Vector2d in_base =
          mount.base_from_laser.translation() +
          beam.range * Eigen::Vector2d(std::cos(heading), std::sin(heading));
      beam.point = Move(base_velocity, beam.time_offset) * in_base;
    }
    model.beams.push_back(beam);
  }
  return model;
}

}  // namespace scan_image_slam
