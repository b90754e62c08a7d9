#pragma once

#include "scan_image_slam/core/sensor/laser_scan.h"
#include "scan_image_slam/core/simulation/laser_caster.h"
#include "scan_image_slam/core/simulation/laser_options.h"
#include "scan_image_slam/core/simulation/motion_history.h"
#include "scan_image_slam/core/simulation/random_stream.h"

#include <cstdint>

namespace scan_image_slam {

/// A scan and when its first beam was really fired (its stamp may be wrong).
struct SimulatedScan {
  LaserScan scan;
  Stamp first_beam = 0;  ///< true time of the first beam [ns]
  Stamp complete = 0;    ///< true time of the last beam [ns]
  Stamp arrival = 0;     ///< when the computer gets it [ns]
};

/// The rays of one sweep that begins at `first_beam`; time 0 of the world is `start`.
LaserFan MakeFan(const LaserSimulatorOptions& options, const MotionHistory& history,
                 Stamp first_beam, Stamp start);

/// A scanning laser on a moving robot: every beam starts where the laser is when it fires.
class LaserSimulator {
 public:
  /// `world` must outlive the simulator; time 0 of the world is `start`. Throws
  /// std::invalid_argument for wrong options.
  LaserSimulator(const World& world, const LaserSimulatorOptions& options, std::uint64_t seed,
                 Stamp start);

  /// Time of the last beam of the next scan: what Measure() needs to know the motion up to [ns].
  Stamp NextComplete() const;

  /// Takes the next scan. Two calls never get the same scan.
  SimulatedScan Measure(const MotionHistory& history);

 private:
  /// One range before coding, or +Inf if nothing comes back [m].
  double Range(const LaserHits& hits, std::size_t beam);
  double Disturb(const LaserHit& hit, double mixed_range);
  double MixedRange(const LaserHits& hits, std::size_t beam, const LaserHit& middle);
  LaserHit Returned(const LaserHits& hits, std::size_t ray, double chance) const;
  bool Lost(const LaserHit& hit, double chance) const;
  float Code(double range) const;
  Stamp FirstBeam() const;

  const World& world_;
  LaserSimulatorOptions options_;
  LaserCaster caster_;
  RandomStream noise_;
  RandomStream timing_;
  Stamp start_;
  std::int64_t count_ = 0;
  Stamp last_stamp_;
  Stamp last_arrival_;
};

}  // namespace scan_image_slam
