#pragma once

#include "scan_image_slam/core/sensor/odometry_buffer.h"
#include "scan_image_slam/core/sensor/reading_pace.h"
#include "scan_image_slam/core/sensor/stamp.h"

#include <algorithm>
#include <deque>
#include <optional>
#include <utility>

namespace scan_image_slam {

/// Holds scans until the encoders have reached their stamp, but not for long, and not at all if the
/// encoders, which come at an even pace, will not get there in time: scans and encoders come by
/// different ways, and neither order is wrong. Scans leave in the order in which they came. Time in
/// which nobody looked does not count: who was kept from looking was kept from the encoders, too.
/// The first reading is waited for longer, once: where a chain of scans begins by the encoders, it
/// must not begin without them by chance.
template <typename Item>
class OdometryGate {
 public:
  /// `max_wait` [s]; of more than `max_items` waiting scans the oldest are dropped; `encoders`:
  /// there may be some.
  OdometryGate(double max_wait, std::size_t max_items, bool encoders = true)
      : max_wait_(max_wait),
        max_items_(max_items),
        patience_(max_wait),
        encoders_(encoders),
        without_encoders_(!encoders) {}

  void set_max_wait(double max_wait) { max_wait_ = max_wait; }

  /// `now` is any clock that goes on while messages arrive, e.g. the time of arrival [ns].
  void Push(Item item, Stamp stamp, Stamp now) {
    NoticeLateLook(now);
    waiting_.push_back({std::move(item), stamp, now, now});
    while (waiting_.size() > max_items_) {
      waiting_.pop_front();
      ++dropped_;
    }
  }

  /// The next scan that need not wait any longer, if there is one. To be called for each scan, for
  /// each reading of the encoders, and when TimeLeft() is over.
  std::optional<Item> Pop(Stamp now, const OdometryBuffer& odometry) {
    NoticeLateLook(now);
    if (!odometry.empty()) pace_.Watch(odometry.newest_stamp(), now);
    if (waiting_.empty()) return std::nullopt;
    const bool reached = !odometry.empty() && odometry.newest_stamp() >= waiting_.front().stamp;
    const bool before_first = odometry.empty() && !without_encoders_;
    patience_ = before_first ? std::max(max_wait_, kFirstWait) : max_wait_;
    const bool waited = Seconds(now - waiting_.front().begin) >= patience_;
    // Encoders that have let the last scan wait in vain, and have said nothing since, are silent.
    const bool silent = silent_since_ && *silent_since_ == odometry.newest_stamp();
    const std::optional<Stamp> due = pace_.Due(waiting_.front().stamp);
    const bool in_vain = due && Seconds(*due - waiting_.front().arrival) > max_wait_;
    if (!reached && !waited && !silent && !in_vain) return std::nullopt;
    if (reached) {
      silent_since_.reset();
    } else if (waited) {
      silent_since_ = odometry.newest_stamp();
      without_encoders_ = odometry.empty();
    }
    std::optional<Item> item(std::move(waiting_.front().item));
    waiting_.pop_front();
    return item;
  }

  /// How long the next scan may still wait, if there is one, above 0 unless Pop() was left out [s].
  std::optional<double> TimeLeft(Stamp now) const {
    if (waiting_.empty()) return std::nullopt;
    return patience_ - Seconds(now - waiting_.front().begin);
  }

  std::size_t size() const { return waiting_.size(); }
  int dropped() const { return dropped_; }
  /// Time went back, or everything starts over.
  void Clear() {
    waiting_.clear();
    silent_since_.reset();
    pace_ = ReadingPace();
    without_encoders_ = !encoders_;
  }

 private:
  static constexpr double kFirstWait = 0.2;  // for the first reading of all [s]

  struct Waiting {
    Item item;
    Stamp stamp;
    Stamp arrival;
    Stamp begin;  ///< of the wait
  };

  /// After a long time without a look nothing is known of the encoders' pace or silence, and scans
  /// begin to wait anew, if they are not too old by now.
  void NoticeLateLook(Stamp now) {
    constexpr double kLate = 0.2;    // slow encoders and lasers take nearly as long [s]
    constexpr double kTooOld = 1.0;  // [s]
    const bool late = Seconds(now - looked_) > max_wait_ + kLate;
    looked_ = now;
    if (!late) return;
    pace_ = ReadingPace();
    silent_since_.reset();
    for (Waiting& scan : waiting_) {
      if (Seconds(now - scan.arrival) < kTooOld) scan.begin = now;
    }
  }

  double max_wait_;
  std::size_t max_items_;
  double patience_;  ///< with the next scan [s]
  bool encoders_;
  bool without_encoders_;  ///< none, or their first reading was waited for in vain
  ReadingPace pace_;
  std::deque<Waiting> waiting_;
  Stamp looked_ = 0;
  std::optional<Stamp> silent_since_;
  int dropped_ = 0;
};

}  // namespace scan_image_slam
