#pragma once

#include "scan_image_slam/core/geometry/pose2.h"
#include "scan_image_slam/core/matching/search_window.h"
#include "scan_image_slam/core/sensor/odometry_buffer.h"

#include <optional>

#include <Eigen/Core>

namespace scan_image_slam {

/// Standard deviation of a predicted motion: how wrong the encoders usually are, where MotionBounds
/// says how wrong they can be.
struct MotionNoise {
  double distance_per_distance = 0.05;  ///< [m/m]
  double distance_per_time = 0.04;      ///< [m/s]
  double min_distance = 0.0003;         ///< [m]
  double lateral_fraction = 0.7;        ///< sideways, of that along the way [-]
  double angle_per_angle = 0.2;         ///< [rad/rad]
  double angle_per_distance = 0.1;      ///< [rad/m]
  double angle_per_time = 0.2;          ///< [rad/s]
  double min_angle = 0.0003;            ///< [rad]
  /// Throws std::invalid_argument, naming the field, if a value is negative or not finite.
  void Validate() const;
};

struct MotionPredictorOptions {
  OdometryOptions odometry;
  MotionBounds bounds;
  MotionNoise noise;
  /// Sideways bound without encoders, as a fraction of D: the laser may be carried by hand [-].
  double lateral_per_distance_without_encoders = 1.0;
  /// Throws std::invalid_argument, naming the field, if a value is out of range.
  void Validate() const;
};

/// Where the base should be by now, and how wrong that can be.
struct MotionPrediction {
  Pose2 motion;                ///< of the base since the last scan
  double dt = 0.0;             ///< time since the last scan, at least the usual period [s]
  bool from_encoders = false;  ///< false: the velocity of the last match, kept
  /// True if encoders say nothing, or nothing yet, of a gap longer than bounds.max_time: the robot
  /// may be outside of the window.
  bool blind = false;
  SearchWindow window;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of (forward, left, turn) [m, m, rad]
  std::optional<Pose2> odom_from_base;                   ///< in the frame of the odometry
};

/// Predicts the motion between scans from the encoders or, without them, from the last motion.
class MotionPredictor {
 public:
  explicit MotionPredictor(const MotionPredictorOptions& options);

  /// From the next prediction on; the limits of the odometry stay.
  void SetOptions(const MotionPredictorOptions& options) { options_ = options; }

  OdometryBuffer& odometry() { return odometry_; }
  const OdometryBuffer& odometry() const { return odometry_; }

  /// For the scan at `stamp`, later than the last one.
  MotionPrediction Predict(Stamp stamp) const;

  /// Tells the motion that was found for the scan of the last prediction.
  void Update(Stamp stamp, const Pose2& matched_motion);

  /// Velocity of the last match.
  const Velocity2& velocity() const { return velocity_; }

 private:
  MotionPredictorOptions options_;
  OdometryBuffer odometry_;
  std::optional<Stamp> last_stamp_;
  std::optional<Pose2> last_continuous_from_base_;
  double period_ = 0.0;
  Velocity2 velocity_;
};

}  // namespace scan_image_slam
