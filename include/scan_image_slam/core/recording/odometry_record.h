#pragma once

#include "scan_image_slam/core/recording/finding.h"
#include "scan_image_slam/core/sensor/odometry_buffer.h"

#include <optional>
#include <string>

namespace scan_image_slam {

/// What the encoders of a recording say.
class OdometryRecord {
 public:
  explicit OdometryRecord(const OdometryOptions& options = {}) : buffer_(options) {}

  void Add(Stamp stamp, const Pose2& odom_from_base);

  double way() const { return way_; }        ///< driven, without jumps [m]
  double turned() const { return turned_; }  ///< without jumps [rad]
  int resets() const { return resets_; }     ///< jumps that no robot makes
  Stamp first_reset() const { return first_reset_; }

 private:
  OdometryBuffer buffer_;  ///< tells jumps as the nodes do
  std::optional<Pose2> last_;
  double way_ = 0.0;
  double turned_ = 0.0;
  int resets_ = 0;
  Stamp first_reset_ = 0;
};

/// What is odd in the encoders; `begin` of their topic [ns].
Findings CheckOdometry(const std::string& topic, const OdometryRecord& record, Stamp begin);

}  // namespace scan_image_slam
