#pragma once

#include "scan_image_slam/core/sensor/stamp.h"

#include <optional>

#include <ros/time.h>

namespace scan_image_slam {

/// Judges the stamps of a stream that should advance.
class TimeGuard {
 public:
  enum class Verdict {
    kAdvances,
    kStale,     ///< repeats or goes back: leave this message out
    kRestarts,  ///< time itself went back (bag played again, clock set): start over
  };
  Verdict Check(Stamp stamp) {
    const ros::Time now = ros::Time::now();
    const bool clock_went_back = ros::Time::isSimTime() && now < last_now_;
    last_now_ = now;
    if (clock_went_back) {
      last_stamp_ = stamp;
      return Verdict::kRestarts;
    }
    if (last_stamp_ && stamp <= *last_stamp_) {
      // A clock that was set back makes every message stale from then on.
      constexpr int kPatience = 40;
      if (++stale_in_a_row_ < kPatience) return Verdict::kStale;
      stale_in_a_row_ = 0;
      last_stamp_ = stamp;
      return Verdict::kRestarts;
    }
    stale_in_a_row_ = 0;
    last_stamp_ = stamp;
    return Verdict::kAdvances;
  }

 private:
  ros::Time last_now_;
  std::optional<Stamp> last_stamp_;
  int stale_in_a_row_ = 0;
};

}  // namespace scan_image_slam
