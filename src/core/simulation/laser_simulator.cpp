#include "scan_image_slam/core/simulation/laser_simulator.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace scan_image_slam {
namespace {

constexpr double kNothing = std::numeric_limits<double>::infinity();
constexpr int kRaysPerSpot = 3;
constexpr double kGlassFlash = 0.02;  // probability that slanted glass returns, e.g. from dirt

double IncidenceOf(const LaserHit& hit) { return std::acos(std::min(hit.cosine, 1.0)); }

}  // namespace

LaserFan MakeFan(const LaserSimulatorOptions& options, const MotionHistory& history,
                 Stamp first_beam, Stamp start) {
  LaserFan fan;
  const int rays = options.mixed_pixels ? kRaysPerSpot : 1;
  fan.rays_per_beam = rays;
  fan.half_width = options.mixed_pixels ? options.beam_width / 2.0 : 0.0;
  fan.rays.resize(static_cast<std::size_t>(options.beams) * rays);
  fan.bearings.resize(options.beams);
  fan.times.resize(options.beams);
  const double side = options.upside_down ? -1.0 : 1.0;
  const double first_heading = history.At(first_beam).world_from_base.theta;
  for (int beam = 0; beam < options.beams; ++beam) {
    const Stamp time = first_beam + FromSeconds(beam * options.TimeIncrement());
    const Pose2 world_from_base = history.At(time).world_from_base;
    const Eigen::Vector2d origin = world_from_base * options.mount.Planar().translation();
    const double heading = first_heading + NormalizeAngle(world_from_base.theta - first_heading);
    const double bearing =
        heading + options.mount.yaw + side * (options.angle_min + beam * options.angle_increment);
    fan.bearings[beam] = bearing;
    fan.times[beam] = Seconds(time - start);
    for (int i = 0; i < rays; ++i) {
      const double angle = bearing + (rays > 1 ? (i - 1) * fan.half_width : 0.0);
      fan.rays[static_cast<std::size_t>(beam) * rays + i] = {origin,
                                                             {std::cos(angle), std::sin(angle)}};
    }
  }
  return fan;
}

LaserSimulator::LaserSimulator(const World& world, const LaserSimulatorOptions& options,
                               std::uint64_t seed, Stamp start)
    : world_(world),
      options_((options.Validate(), options)),
      caster_(world, options.mount.z),
      noise_(seed, "laser noise"),
      timing_(seed, "laser timing"),
      start_(start),
      last_stamp_(std::numeric_limits<Stamp>::min()),
      last_arrival_(start) {}

Stamp LaserSimulator::FirstBeam() const {
  return start_ + FromSeconds(options_.phase + static_cast<double>(count_) * options_.Period());
}

Stamp LaserSimulator::NextComplete() const {
  return FirstBeam() + FromSeconds((options_.beams - 1) * options_.TimeIncrement());
}

LaserHit LaserSimulator::Returned(const LaserHits& hits, std::size_t ray, double chance) const {
  const LaserHit& glass = hits.glass[ray];
  const LaserHit& solid = hits.solid[ray];
  const bool reflects = IncidenceOf(glass) <= options_.glass_angle || chance < kGlassFlash;
  return glass.range < solid.range && reflects ? glass : solid;
}

bool LaserSimulator::Lost(const LaserHit& hit, double chance) const {
  const bool dark = hit.surface >= 0 && world_.walls[hit.surface].laser == LaserReturn::kDark;
  if (dark && hit.range > options_.dark_range) return true;
  const double beyond = IncidenceOf(hit) - options_.grazing_drop_angle;
  const double grazing = beyond > 0.0 ? beyond / (M_PI_2 - options_.grazing_drop_angle) : 0.0;
  return chance < options_.drop_rate + grazing * grazing;
}

double LaserSimulator::MixedRange(const LaserHits& hits, std::size_t beam, const LaserHit& middle) {
  // Always drawn, so that what one beam hits does not change the noise of the next.
  const double blend = noise_.Normal();
  if (!options_.mixed_pixels) return middle.range;
  const std::size_t first = beam * kRaysPerSpot;
  double near = kNothing;
  double far = 0.0;
  int near_count = 0;
  for (std::size_t ray = first; ray < first + kRaysPerSpot; ++ray) {
    near = std::min(near, hits.solid[ray].range);
    far = std::max(far, hits.solid[ray].range);
  }
  // The spot's own length along the ray on a slanted wall is no discontinuity.
  const double slant = std::tan(std::min(IncidenceOf(middle), 1.55));
  const double length = 2.0 * options_.beam_width * middle.range * slant;
  if (far - near < 0.05 + length || far == kNothing || far - near > options_.mixed_depth) {
    return middle.range;
  }
  for (std::size_t ray = first; ray < first + kRaysPerSpot; ++ray) {
    near_count += hits.solid[ray].range < 0.5 * (near + far) ? 1 : 0;
  }
  const double weight = static_cast<double>(near_count) / kRaysPerSpot + 0.2 * blend;
  return far + std::clamp(weight, 0.0, 1.0) * (near - far);
}

double LaserSimulator::Disturb(const LaserHit& hit, double mixed_range) {
  const double noise = noise_.Normal();
  const double growth = std::clamp((hit.range - 10.0) / 10.0, 0.0, 1.0);
  const double stddev =
      options_.range_stddev + growth * (options_.far_range_stddev - options_.range_stddev);
  const double sine = std::sqrt(std::max(0.0, 1.0 - hit.cosine * hit.cosine));
  const double spot = options_.beam_width * hit.range * sine / std::max(hit.cosine, 0.02);
  double bias = options_.incidence_bias * (1.0 - hit.cosine);
  if (hit.surface >= 0 && world_.walls[hit.surface].laser == LaserReturn::kDark) {
    bias += options_.dark_bias;
  }
  return mixed_range + bias + noise * std::hypot(stddev, options_.grazing_noise * spot);
}

double LaserSimulator::Range(const LaserHits& hits, std::size_t beam) {
  const double glass_chance = noise_.Uniform();
  const double loss_chance = noise_.Uniform();
  const int rays = options_.mixed_pixels ? kRaysPerSpot : 1;
  const LaserHit hit = Returned(hits, beam * rays + rays / 2, glass_chance);
  const double mixed = MixedRange(hits, beam, hit);
  const bool behind_glass = hits.glass[beam * rays + rays / 2].range <= hit.range;
  const double range = Disturb(hit, behind_glass ? hit.range : mixed);
  return hit.surface == -1 || Lost(hit, loss_chance) ? kNothing : range;
}

float LaserSimulator::Code(double range) const {
  const double q = options_.quantum;
  if (q > 0.0 && std::isfinite(range)) range = std::round(range / q) * q;
  if (range >= options_.range_min && range <= options_.range_max) return static_cast<float>(range);
  switch (options_.no_return) {
    case NoReturn::kInfinity:
      return std::numeric_limits<float>::infinity();
    case NoReturn::kOneMillimetre:
      return 0.001F;
    case NoReturn::kZero:
      return 0.0F;
    case NoReturn::kNan:
      break;
  }
  return std::numeric_limits<float>::quiet_NaN();
}

SimulatedScan LaserSimulator::Measure(const MotionHistory& history) {
  SimulatedScan result;
  result.first_beam = FirstBeam();
  result.complete = NextComplete();
  ++count_;
  const LaserHits hits = caster_.Cast(MakeFan(options_, history, result.first_beam, start_));
  LaserScan& scan = result.scan;
  scan.angle_min = options_.angle_min;
  scan.angle_increment = options_.angle_increment;
  scan.time_increment = options_.TimeIncrement();
  scan.range_min = options_.range_min;
  scan.range_max = options_.range_max;
  scan.ranges.reserve(options_.beams);
  for (int beam = 0; beam < options_.beams; ++beam) scan.ranges.push_back(Code(Range(hits, beam)));

  const double error = options_.stamp_offset + options_.stamp_jitter * timing_.Normal();
  scan.stamp = std::max(result.first_beam + FromSeconds(error), last_stamp_ + 1);
  last_stamp_ = scan.stamp;
  const double delay = options_.latency + timing_.Exponential(options_.latency_jitter);
  result.arrival = std::max(result.complete + FromSeconds(delay), last_arrival_ + 1);
  last_arrival_ = result.arrival;
  return result;
}

}  // namespace scan_image_slam
