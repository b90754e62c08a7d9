#pragma once

#include "scan_image_slam/core/geometry/pose2.h"
#include "scan_image_slam/core/sensor/stamp.h"

#include <deque>

namespace scan_image_slam {

/// The robot's true motion at one moment.
struct TrueState {
  Stamp time = 0;          ///< [ns]
  Pose2 world_from_base;   ///< base: on the floor between the wheels
  double speed = 0.0;      ///< ahead [m/s]
  double turn_rate = 0.0;  ///< [rad/s]
};

/// The recent true motion, so that sensors that finish now know where they were before.
class MotionHistory {
 public:
  explicit MotionHistory(double length) : length_(length) {}  ///< kept at least [s]

  void Add(const TrueState& state);

  /// State at a time within the history, between two entries by interpolation; times outside get
  /// the first or the last entry. The history must not be empty.
  TrueState At(Stamp time) const;

  bool empty() const { return states_.empty(); }

 private:
  double length_;
  std::deque<TrueState> states_;
};

}  // namespace scan_image_slam
