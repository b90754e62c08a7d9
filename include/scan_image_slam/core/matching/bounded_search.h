#pragma once

#include "scan_image_slam/core/geometry/pose2.h"
#include "scan_image_slam/core/matching/search_window.h"

#include <cmath>
#include <limits>
#include <vector>

namespace scan_image_slam {

/// Grid of motions that the exhaustive search tries inside the window.
struct SearchGrid {
  double distance_step = 0.06;   ///< largest step of distance and sideways [m]
  double angle_step = 0.025;     ///< largest step of the angle [rad]
  double deviation_cost = 1e-4;  ///< added to e per grid step away from the prediction [m]
  /// Throws std::invalid_argument, naming the field, if a step is not positive and finite.
  void Validate() const;
};

/// One motion to try: its deviation from the prediction and how many grid steps away that is.
struct Candidate {
  ArcCoordinates deviation;
  int steps = 0;
};

/// All motions of the grid, nearest to the prediction first. The window's borders are among them,
/// and nothing is outside. Sideways motions only if `search_lateral`.
std::vector<Candidate> MakeCandidates(const SearchWindow& window, const SearchGrid& grid,
                                      bool search_lateral);

/// The candidate with the smallest e.
struct SearchResult {
  ArcCoordinates deviation;     ///< from the predicted motion
  double e = 0.0;               ///< mean distance between the models, deviation cost left out [m]
  int candidates = 0;           ///< motions in the window
  bool on_window_edge = false;  ///< the best distance or angle is the last of the window
};

/// Steps 3 to 5 of the paper. `mean_e(deviation, limit)` returns the e of one motion (eq. 4), or
/// anything not below `limit` as soon as e is known to reach it: candidates are only compared, so
/// this changes nothing but the speed. Ties go to the candidate nearer to the prediction.
template <typename MeanDistance>
SearchResult SearchExhaustively(const std::vector<Candidate>& candidates,
                                const SearchWindow& window, const SearchGrid& grid,
                                const MeanDistance& mean_e) {
  SearchResult best;
  best.candidates = static_cast<int>(candidates.size());
  double best_cost = std::numeric_limits<double>::infinity();
  for (const Candidate& candidate : candidates) {
    const double extra = grid.deviation_cost * candidate.steps;
    const double limit = best_cost - extra;
    const double e = mean_e(candidate.deviation, limit);
    if (e >= limit) continue;
    best_cost = e + extra;
    best.deviation = candidate.deviation;
    best.e = e;
  }
  const auto at_border = [](double value, double half) {
    return half > 0.0 && std::abs(value) >= half * (1.0 - 1e-9);
  };
  best.on_window_edge = at_border(best.deviation.distance, window.half_distance) ||
                        at_border(best.deviation.angle, window.half_angle);
  return best;
}

}  // namespace scan_image_slam
