#pragma once

#include "scan_image_slam/core/sensor/stamp.h"

#include <optional>

namespace scan_image_slam {

/// Judges the stamps of a stream that should advance.
class TimeGuard {
 public:
  enum class Verdict {
    kAdvances,
    kStale,     ///< repeats or goes back: leave this message out
    kAhead,     ///< leaps ahead of the clock: leave this message out
    kRestarts,  ///< time itself went back (bag played again, clock set): start over
  };
  /// `now`: by the clock at which messages arrive, or were recorded [ns]; `simulated`: that clock
  /// goes back if a bag is played again.
  Verdict Check(Stamp stamp, Stamp now, bool simulated) {
    if (simulated && now < last_now_) clock_went_back_ = true;
    last_now_ = now;
    const Stamp lead = stamp - now;
    // After the clock has gone back, what was sent before is still on its way: it is ahead of time.
    const bool ahead = lead > kMaxAhead;
    const bool restarts = clock_went_back_ && !ahead;
    const bool stale = clock_went_back_ ? ahead : last_stamp_ && stamp <= *last_stamp_;
    // One that comes alone would make all that follow it stale.
    const bool leaps = !clock_went_back_ && ahead && last_stamp_ &&
                       stamp > *last_stamp_ + kMaxLeap && lead > lead_ + kMaxLeap;
    // A clock that was set makes every message so from then on.
    if ((stale || leaps) && ++odd_in_a_row_ < kPatience) {
      return leaps ? Verdict::kAhead : Verdict::kStale;
    }
    clock_went_back_ = false;
    odd_in_a_row_ = 0;
    last_stamp_ = stamp;
    lead_ = lead;
    return restarts || stale ? Verdict::kRestarts : Verdict::kAdvances;
  }

 private:
  static constexpr int kPatience = 40;             ///< messages
  static constexpr Stamp kMaxAhead = 200'000'000;  ///< clocks of drivers may be a little fast [ns]
  static constexpr Stamp kMaxLeap =
      1'000'000'000;  ///< a clock that is fast all along has none [ns]
  Stamp last_now_ = 0;
  std::optional<Stamp> last_stamp_;
  Stamp lead_ = 0;                ///< of that stamp before the clock
  bool clock_went_back_ = false;  ///< and nothing has begun anew yet
  int odd_in_a_row_ = 0;          ///< messages that were left out
};

}  // namespace scan_image_slam
