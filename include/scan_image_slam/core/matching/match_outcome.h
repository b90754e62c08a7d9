#pragma once

#include "scan_image_slam/core/geometry/pose2.h"
#include "scan_image_slam/core/matching/edge_match.h"

#include <vector>

#include <Eigen/Core>

namespace scan_image_slam {

/// Where in the window the best motion lies, and what speaks for it.
struct MatchEvidence {
  ArcCoordinates deviation;    ///< from the predicted motion
  Velocity2 sweep_correction;  ///< to be added to the velocity that the sweep was corrected with
  Velocity2 edge_correction;   ///< to that of the edges between image and scan
  double e = 0.0;      ///< eq. 4: mean distance between the models at the best candidate [m]
  double rms = 0.0;    ///< residual across the walls after the refinement [m]
  int candidates = 0;  ///< motions tried
  int points = 0;      ///< hits of the scan
  int matched = 0;     ///< hits that found a counterpart
  std::vector<EdgeMatch> edges;       ///< of the model, in its order; empty: not looked at
  double degenerate_direction = 0.0;  ///< left to the prediction, in the base frame [rad]
};

/// What a matcher says of one scan.
struct MatchOutcome : MatchEvidence {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of (forward, left, turn) [m, m, rad]
  bool on_window_edge = false;
  bool too_few_points = false;  ///< the scan shows too little of what is known
  bool undecided = false;  ///< and the prediction is blind: nothing was learned, the motion is open
  bool degenerate = false;  ///< one direction was left to the prediction
};

}  // namespace scan_image_slam
