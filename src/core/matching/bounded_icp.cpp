#include "scan_image_slam/core/matching/bounded_icp.h"

#include "scan_image_slam/core/geometry/covariance.h"

#include <cmath>
#include <stdexcept>

namespace scan_image_slam {
namespace {

/// Images come less often than scans; so long after one its edges still count as seen [s].
constexpr double kImageLife = 0.2;

MatchStatus StatusOf(const MatchOutcome& outcome) {
  if (outcome.too_few_points) return MatchStatus::kTooFewPoints;
  if (outcome.on_window_edge) return MatchStatus::kOnWindowEdge;
  return outcome.degenerate ? MatchStatus::kDegenerate : MatchStatus::kMatched;
}

}  // namespace

void BoundedIcpOptions::Validate() const {
  prediction.Validate();
  local_map_matcher.Validate();
}

BoundedIcp::BoundedIcp(const BoundedIcpOptions& options)
    : options_(options),
      predictor_(options.prediction),
      local_map_matcher_(options.local_map_matcher),
      frame_matcher_(options.frame_matcher) {}

void BoundedIcp::SetOptions(const BoundedIcpOptions& options) {
  options.Validate();
  options_.prediction = options.prediction;
  options_.local_map_matcher = options.local_map_matcher;
  predictor_.SetOptions(options.prediction);
  local_map_matcher_.SetOptions(options.local_map_matcher);
}

MatchedMotion BoundedIcp::Match(const FusedModel& model) {
  if (last_stamp_ && model.stamp <= *last_stamp_) {
    throw std::invalid_argument("the stamp of a model must be later than that of the last one");
  }
  const bool use_local_map = options_.reference == Reference::kLocalMap;
  const MotionPrediction prediction = predictor_.Predict(model.stamp);
  MatchedMotion match;
  match.stamp = model.stamp;
  match.odom_from_base = prediction.odom_from_base;
  match.window = prediction.window;
  Pose2 start_from_base = start_from_base_;
  if (!last_stamp_) {
    match.status = MatchStatus::kFirst;
    start_stamp_ = model.stamp;
    reference_stamp_ = model.stamp;
    if (use_local_map) {
      local_map_matcher_.Start(model, start_from_base_);
    } else {
      frame_matcher_.Start(model);
    }
    predictor_.Update(model.stamp, Pose2());
  } else {
    const MatchOutcome outcome = use_local_map
                                     ? local_map_matcher_.Match(model, start_from_base_, prediction)
                                     : frame_matcher_.Match(model, prediction);
    const Pose2 motion = prediction.motion * FromArcCoordinates(outcome.deviation);
    match.status = StatusOf(outcome);
    static_cast<MatchEvidence&>(match) = outcome;
    // From frame to frame errors add up; against the map they do not.
    covariance_ = use_local_map ? outcome.covariance
                                : TransportCovariance(covariance_, motion) + outcome.covariance;
    start_from_base = start_from_base_ * motion;
    if (!outcome.undecided) {  // else the encoders may still tell the motion from the last scan on
      start_from_base_ = start_from_base;
      predictor_.Update(model.stamp, motion);
    }
  }
  if (model.has_image) last_image_stamp_ = model.stamp;
  match.mode = ModeOf(match);
  match.covariance = covariance_;
  last_stamp_ = model.stamp;
  ChooseReference(start_from_base, &match);
  return match;
}

MatchMode BoundedIcp::ModeOf(const MatchedMotion& match) const {
  if (match.status == MatchStatus::kTooFewPoints) return MatchMode::kCoasting;
  const bool images = last_image_stamp_ && Seconds(match.stamp - *last_image_stamp_) <= kImageLife;
  if (match.odom_from_base) return images ? MatchMode::kFull : MatchMode::kNoCamera;
  return images ? MatchMode::kNoEncoders : MatchMode::kLaserOnly;
}

/// Motions are told from a scan not far back, so that they stay small and mean what was measured.
void BoundedIcp::ChooseReference(const Pose2& start_from_base, MatchedMotion* match) {
  match->start_stamp = start_stamp_;
  match->reference_stamp = reference_stamp_;
  match->start_from_reference = start_from_reference_;
  match->motion = start_from_reference_.Inverse() * start_from_base;
  const bool too_far = options_.reference == Reference::kPreviousFrame ||
                       match->motion.translation().norm() > options_.reference_distance ||
                       std::abs(match->motion.theta) > options_.reference_angle;
  if (too_far) {
    reference_stamp_ = match->stamp;
    start_from_reference_ = start_from_base;
  }
}

}  // namespace scan_image_slam
