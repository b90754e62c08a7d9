#pragma once

#include "scan_image_slam/core/sensor/stamp.h"

#include <algorithm>
#include <optional>

namespace scan_image_slam {

/// Foretells when the readings of a sensor that tells at an even pace will have reached a stamp.
class ReadingPace {
 public:
  /// The newest reading so far, looked at when it comes at `now`, by any clock that goes on [ns].
  void Watch(Stamp newest, Stamp now) {
    if (newest_ && newest == *newest_) return;
    const Stamp interval = newest_ ? newest - *newest_ : 0;
    if (interval > 0) {
      // The shorter of the last two, as one reading may be missed.
      if (last_interval_) period_ = std::min(interval, *last_interval_);
      last_interval_ = interval;
    } else {  // the first one, or time went back
      last_interval_.reset();
      period_.reset();
    }
    newest_ = newest;
    arrival_ = now;
  }

  /// When a reading of this stamp or later comes, by the clock of Watch; nothing is foretold before
  /// three readings were seen.
  std::optional<Stamp> Due(Stamp stamp) const {
    if (!period_) return std::nullopt;
    const Stamp ahead = std::max<Stamp>(0, stamp - *newest_);
    const Stamp readings = (ahead + *period_ - 1) / *period_;
    return arrival_ + readings * *period_;
  }

 private:
  std::optional<Stamp> newest_;
  Stamp arrival_ = 0;  // of the newest
  std::optional<Stamp> last_interval_;
  std::optional<Stamp> period_;
};

}  // namespace scan_image_slam
