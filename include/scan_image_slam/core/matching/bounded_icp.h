#pragma once

#include "scan_image_slam/core/fusion/fused_model.h"
#include "scan_image_slam/core/matching/frame_matcher.h"
#include "scan_image_slam/core/matching/local_map_matcher.h"
#include "scan_image_slam/core/matching/matched_motion.h"
#include "scan_image_slam/core/matching/motion_predictor.h"

#include <optional>

namespace scan_image_slam {

/// What the scans are matched with.
enum class Reference {
  kPreviousFrame,  ///< the last model: the letter of the paper
  kLocalMap,       ///< all that was seen: does not drift with every frame
};

struct BoundedIcpOptions {
  Reference reference = Reference::kLocalMap;
  MotionPredictorOptions prediction;
  LocalMapMatcherOptions local_map_matcher;  ///< used with Reference::kLocalMap
  FrameMatcherOptions frame_matcher;         ///< used with Reference::kPreviousFrame
  double reference_distance = 0.5;  ///< motions are told from a scan at most so far back [m]
  double reference_angle = 0.5;     ///< [rad]
  /// Throws std::invalid_argument, naming the field, if a value is out of range.
  void Validate() const;
};

/// The second stage of the system: the motion of the base between scans, within the bounds that the
/// encoders leave (section 2.2 of the paper).
class BoundedIcp {
 public:
  explicit BoundedIcp(const BoundedIcpOptions& options);

  /// Encoder readings, in any rate; see OdometryBuffer.
  OdometryBuffer::Result AddOdometry(Stamp stamp, const Pose2& odom_from_base) {
    return predictor_.odometry().Add(stamp, odom_from_base);
  }
  const OdometryBuffer& odometry() const { return predictor_.odometry(); }

  /// Matches the next model. Throws std::invalid_argument if its stamp is not later than the last.
  MatchedMotion Match(const FusedModel& model);

  /// What the matching with the local map has learned of encoders and camera.
  LearnedCalibration learned() const { return local_map_matcher_.filter().learned(); }

  /// From the next model on: bounds and noise of the motion, search, edges, refinement. What was
  /// seen stays, and with it the reference, the laser's noise, the surface elements and the limits
  /// of the odometry, until Reset. Throws std::invalid_argument, and changes nothing, if a value is
  /// out of range.
  void SetOptions(const BoundedIcpOptions& options);

  /// Forgets everything, as time went back.
  void Reset() { *this = BoundedIcp(options_); }

  /// Forgets all but the encoders: the next model begins another chain where they are.
  void BeginAnew() {
    OdometryBuffer odometry = std::move(predictor_.odometry());
    Reset();
    predictor_.odometry() = std::move(odometry);
  }

 private:
  void ChooseReference(const Pose2& start_from_base, MatchedMotion* match);
  MatchMode ModeOf(const MatchedMotion& match) const;

  BoundedIcpOptions options_;
  MotionPredictor predictor_;
  LocalMapMatcher local_map_matcher_;
  FrameMatcher frame_matcher_;
  std::optional<Stamp> last_stamp_;
  std::optional<Stamp> last_image_stamp_;  ///< of the last model that an image was fused into
  Pose2 start_from_base_;                  ///< of the last scan that was decided
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();
  Stamp start_stamp_ = 0;
  Stamp reference_stamp_ = 0;
  Pose2 start_from_reference_;
};

}  // namespace scan_image_slam
