#pragma once

#include "scan_image_slam/core/fusion/fused_model.h"
#include "scan_image_slam/core/matching/bounded_search.h"
#include "scan_image_slam/core/matching/match_outcome.h"
#include "scan_image_slam/core/matching/motion_predictor.h"

#include <vector>

#include <Eigen/Core>

namespace scan_image_slam {

struct FrameMatcherOptions {
  SearchGrid grid{0.0025, 0.0005, 1e-5};
  double field_of_view = 1.7453;          ///< whole model, beams 1..400 of the paper [rad]
  double frontal_field_of_view = 0.8727;  ///< part of the previous model, beams 101..300 [rad]
  double max_distance = 0.1;              ///< most that one point adds to e [m]
  double edge_gain = 4.0;                 ///< weight of a beam with an edge, beside 1 [-]
  double range_stddev = 0.02;             ///< to turn e into a covariance [m]
};

/// The matching of the paper to the letter: the frontal part of the previous model against the
/// whole current one, over all motions of the window; no refinement, no memory.
class FrameMatcher {
 public:
  explicit FrameMatcher(const FrameMatcherOptions& options) : options_(options) {}

  void Start(const FusedModel& model) { previous_ = model; }
  MatchOutcome Match(const FusedModel& model, const MotionPrediction& prediction);

 private:
  FrameMatcherOptions options_;
  FusedModel previous_;
};

}  // namespace scan_image_slam
