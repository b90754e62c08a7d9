#pragma once

#include "scan_image_slam/core/geometry/pose2.h"
#include "scan_image_slam/core/sensor/stamp.h"

#include <deque>
#include <optional>

namespace scan_image_slam {

/// Limits of what the encoders may report.
struct OdometryOptions {
  double max_speed = 3.0;           ///< faster steps are a reset of the odometry [m/s]
  double max_turn_rate = 7.0;       ///< faster turns are a reset of the odometry [rad/s]
  double max_extrapolation = 0.25;  ///< age of the newest reading that may still be used [s]
  double history = 10.0;            ///< readings kept [s]
  /// Throws std::invalid_argument, naming the field, if a value is not positive and finite.
  void Validate() const;
};

/// The encoders' dead reckoning over time. Readings may come late and at another rate than the
/// scans; poses between them are interpolated, poses just after the newest one extrapolated.
class OdometryBuffer {
 public:
  explicit OdometryBuffer(const OdometryOptions& options);

  enum class Result {
    kAdded,
    kStale,  ///< the stamp does not advance: not used
    kReset,  ///< a jump: motion across it is unknown, the robot is taken to have kept its velocity;
             ///< or, after many stale ones, time has gone back: begun anew where the robot was
  };
  /// `odom_from_base` as the base reports it.
  Result Add(Stamp stamp, const Pose2& odom_from_base);

  /// Pose of the base at `stamp` in a frame that stays continuous across resets, or nothing if the
  /// readings do not reach that time.
  std::optional<Pose2> ContinuousPose(Stamp stamp) const;

  /// True if there are readings before and after `stamp`, with no pause between them.
  bool Surrounds(Stamp stamp) const;

  /// Pose of the base at `stamp` in the frame of the newest readings (`odom`), or nothing.
  std::optional<Pose2> OdomFromBase(Stamp stamp) const;

  /// Forgets all readings (time went back).
  void Clear();

  bool empty() const { return readings_.empty(); }
  Stamp newest_stamp() const { return readings_.empty() ? 0 : readings_.back().stamp; }

 private:
  struct Reading {
    Stamp stamp;
    Pose2 continuous_from_base;
  };
  /// The first reading later than `stamp`.
  std::deque<Reading>::const_iterator After(Stamp stamp) const;
  Result AddStale(Stamp stamp, const Pose2& odom_from_base);
  /// By the last readings, in the frame of the base; zero before the second one.
  Velocity2 NewestVelocity() const;

  OdometryOptions options_;
  std::deque<Reading> readings_;
  Pose2 last_odom_from_base_;
  Pose2 odom_from_continuous_;
  double period_ = 0.0;  ///< usual time between two readings [s]
  int stale_ = 0;        ///< readings in a row, each later than the one before
  Stamp last_stale_ = 0;
};

}  // namespace scan_image_slam
