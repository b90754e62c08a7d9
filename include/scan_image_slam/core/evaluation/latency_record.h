#pragma once

#include "scan_image_slam/core/sensor/stamp.h"

#include <cstddef>
#include <deque>
#include <vector>

namespace scan_image_slam {

/// Pairs scans with the poses of the same stamp. Counting begins with the first pose: scans before
/// it came while the nodes were starting.
class LatencyRecord {
 public:
  /// `arrival` is by any clock that goes on, the same for scans and poses [ns].
  void AddScan(Stamp stamp, Stamp arrival);
  /// Poses come in the order of their scans: a scan that is overtaken was dropped.
  void AddPose(Stamp stamp, Stamp arrival);

  /// Scans and poses to unknown ones count no longer; poses of those that wait do.
  void Close() { closed_ = true; }

  /// From the arrival of each scan to that of its pose, in the order of the poses [ms]; 0 if the
  /// pose came first, as it may by another connection.
  const std::vector<double>& latencies() const { return latencies_; }
  /// Scans that were overtaken by the pose of a later one.
  std::size_t dropped() const { return dropped_; }
  /// Scans whose pose may still come.
  std::size_t waiting() const { return begun_ ? waiting_.size() : 0; }
  /// Poses to whose stamp no scan has come.
  std::size_t strangers() const { return strangers_ + early_.size(); }
  bool begun() const { return begun_; }

 private:
  struct Arrived {
    Stamp stamp;
    Stamp arrival;
  };
  std::deque<Arrived> waiting_;
  std::deque<Stamp> early_;  ///< poses that wait for their scan
  std::vector<double> latencies_;
  std::size_t dropped_ = 0;
  std::size_t strangers_ = 0;
  bool begun_ = false;
  bool closed_ = false;
};

/// Number of values up to each of the ascending `bounds`, the bound before it excluded; the last
/// number is that of the values above all bounds.
std::vector<std::size_t> CountUpTo(const std::vector<double>& values,
                                   const std::vector<double>& bounds);

}  // namespace scan_image_slam
