#pragma once

#include "scan_image_slam/core/recording/number_text.h"

#include <algorithm>
#include <string>

#include <ros/time.h>

namespace scan_image_slam {

/// How long a piece of work takes, for /diagnostics.
class BusyTime {
 public:
  template <typename Work>
  auto Measure(const Work& work) {
    const Stopwatch stopwatch(this);
    return work();
  }

  /// Mean and longest since the last call.
  std::string Text() {
    if (count_ == 0) return "none";
    std::string text =
        "mean " + NumberText(1e3 * sum_ / count_, 1) + ", longest " + NumberText(1e3 * longest_, 1);
    *this = BusyTime();
    return text;
  }

 private:
  class Stopwatch {
   public:
    explicit Stopwatch(BusyTime* time) : time_(time), begin_(ros::SteadyTime::now()) {}
    ~Stopwatch() {
      const double seconds = (ros::SteadyTime::now() - begin_).toSec();
      ++time_->count_;
      time_->sum_ += seconds;
      time_->longest_ = std::max(time_->longest_, seconds);
    }
    Stopwatch(const Stopwatch&) = delete;
    Stopwatch& operator=(const Stopwatch&) = delete;

   private:
    BusyTime* time_;
    ros::SteadyTime begin_;
  };

  int count_ = 0;
  double sum_ = 0.0;      // [s]
  double longest_ = 0.0;  // [s]
};

}  // namespace scan_image_slam
