#include "scan_image_slam/core/recording/odometry_record.h"

#include "scan_image_slam/core/recording/number_text.h"

#include <cmath>

namespace scan_image_slam {

void OdometryRecord::Add(Stamp stamp, const Pose2& odom_from_base) {
  const OdometryBuffer::Result result = buffer_.Add(stamp, odom_from_base);
  if (result == OdometryBuffer::Result::kStale) return;
  if (result == OdometryBuffer::Result::kReset) {
    if (resets_++ == 0) first_reset_ = stamp;
  } else if (last_) {
    const Pose2 motion = last_->Inverse() * odom_from_base;
    way_ += motion.translation().norm();
    turned_ += std::abs(motion.theta);
  }
  last_ = odom_from_base;
}

Findings CheckOdometry(const std::string& topic, const OdometryRecord& record, Stamp begin) {
  constexpr double kStanding = 0.01;  // [m] and [rad]
  Findings findings;
  if (record.resets() > 0) {
    findings.push_back(
        {Severity::kWarning,
         topic + ": the encoders jump " +
             (record.resets() == 1 ? "once" : std::to_string(record.resets()) + " times") +
             ", first " + DurationText(Seconds(record.first_reset() - begin)) +
             " after their first message",
         "a jump is taken as a reset, not as a motion; more than a few mean that the "
         "odometry is broken, or that two drivers publish it"});
  }
  if (record.way() < kStanding && record.turned() < kStanding) {
    findings.push_back({Severity::kWarning, topic + ": the encoders never move",
                        "if the robot did move, look for the fault in the base's driver, or use "
                        "odom_source none"});
  }
  return findings;
}

}  // namespace scan_image_slam
