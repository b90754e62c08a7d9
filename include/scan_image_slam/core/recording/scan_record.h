#pragma once

#include "scan_image_slam/core/recording/finding.h"
#include "scan_image_slam/core/sensor/laser_scan.h"

#include <map>
#include <string>

namespace scan_image_slam {

/// What the scans of one topic look like.
class ScanRecord {
 public:
  void Add(const LaserScan& scan);

  std::size_t scans() const { return scans_; }
  // All below need at least one scan.
  /// The first scan that has the usual number of beams; its ranges are those of any scan.
  const LaserScan& usual() const { return shapes_.at(UsualBeams()).first; }
  std::size_t UsualBeams() const;
  std::size_t unusual() const { return scans_ - shapes_.at(UsualBeams()).second; }
  double FieldOfView() const;  ///< between the first and the last beam [rad]
  double SweepTime() const;    ///< from the first to the last beam; 0 if unknown [s]

  /// Ranges of all scans, by what they say.
  struct Ranges {
    std::size_t all = 0;
    std::size_t hits = 0;
    std::size_t nan = 0;
    std::size_t infinite = 0;    ///< +Inf
    std::size_t beyond = 0;      ///< finite and above range_max
    std::size_t at_maximum = 0;  ///< exactly range_max, a way to say that nothing was seen
    std::size_t zero = 0;
    std::size_t below = 0;  ///< not zero, and below range_min
  };
  const Ranges& ranges() const { return ranges_; }

 private:
  std::size_t scans_ = 0;
  std::map<std::size_t, std::pair<LaserScan, std::size_t>> shapes_;  ///< by number of beams
  Ranges ranges_;
};

/// One line on laser and beams, e.g. `1081 beams, -135 to 135 deg, every 0.25 deg, ...`.
std::string DescribeScans(const ScanRecord& record);

/// What is odd in the scans. `period`: between two of them, 0 if unknown [s].
Findings CheckScans(const std::string& topic, const ScanRecord& record, double period);

}  // namespace scan_image_slam
