#pragma once

#include "scan_image_slam/core/recording/finding.h"
#include "scan_image_slam/core/sensor/stamp.h"

#include <string>
#include <vector>

namespace scan_image_slam {

/// When the messages of one topic were taken, by their stamps, and when they were recorded.
class StampRecord {
 public:
  /// In the order of recording. A stamp of zero means that the driver has set none.
  void Add(Stamp stamp, Stamp recorded);

  std::size_t messages() const { return unstamped_ + backward_ + repeated_ + usable_.size(); }
  std::size_t unstamped() const { return unstamped_; }             ///< stamps of zero
  std::size_t backward() const { return backward_; }               ///< earlier than one before
  std::size_t repeated() const { return repeated_; }               ///< equal to the newest one
  double largest_step_back() const { return largest_step_back_; }  ///< [s]
  std::size_t usable() const { return usable_.size(); }            ///< stamps that advance

  Stamp first() const { return usable_.empty() ? 0 : usable_.front().stamp; }
  Stamp last() const { return usable_.empty() ? 0 : usable_.back().stamp; }
  double Duration() const { return Seconds(last() - first()); }  ///< [s]
  double Period() const;                                         ///< median; 0 if unknown [s]
  double Rate() const { return Period() > 0.0 ? 1.0 / Period() : 0.0; }  ///< [Hz]
  double MeanRate() const;  ///< over the whole time; lower than the rate if there are gaps [Hz]

  /// Time without messages: several periods, and long enough to matter.
  struct Gap {
    double begin;    ///< after the first message [s]
    double seconds;  ///< [s]
  };
  std::vector<Gap> Gaps() const;

  /// From the stamp to the recording: what measuring and sending take, and what the clocks differ.
  double Delay() const;       ///< median [s]
  double DelayDrift() const;  ///< from the first to the last tenth of the messages [s]

 private:
  struct Entry {
    Stamp stamp;
    Stamp recorded;
  };
  double MedianDelay(std::size_t begin, std::size_t end) const;

  std::vector<Entry> usable_;
  std::size_t unstamped_ = 0;
  std::size_t backward_ = 0;
  std::size_t repeated_ = 0;
  double largest_step_back_ = 0.0;
};

/// What is odd in the stamps of a topic for itself.
Findings CheckStamps(const std::string& topic, const StampRecord& record);

/// Whether the clock of a sensor is that of the recorder.
Findings CheckRecordingClock(const std::string& topic, const StampRecord& record);

/// What is odd in the stamps of another sensor's topic, compared with those of the scans.
Findings CompareStamps(const std::string& scan_topic, const StampRecord& scans,
                       const std::string& topic, const StampRecord& record);

}  // namespace scan_image_slam
