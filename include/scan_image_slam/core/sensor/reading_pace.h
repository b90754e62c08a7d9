#pragma once

#include "scan_image_slam/core/sensor/stamp.h"

#include <deque>
#include <optional>

namespace scan_image_slam {

/// Foretells when the readings of a sensor that tells at an even pace may have reached a stamp.
class ReadingPace {
 public:
  /// The newest reading so far, looked at when it comes at `now`, by any clock that goes on [ns].
  void Watch(Stamp newest, Stamp now);

  /// The earliest time, by the clock of Watch, at which a reading of about this stamp or later is
  /// to be expected. Nothing is foretold of readings that are few or come unevenly, as where time
  /// goes back.
  std::optional<Stamp> Due(Stamp stamp) const;

 private:
  struct Reading {
    Stamp stamp = 0;
    Stamp arrival = 0;
  };
  std::deque<Reading> readings_;  ///< the last ones
};

}  // namespace scan_image_slam
