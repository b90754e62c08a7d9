#include "scan_image_slam/core/matching/bounded_search.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <string>

namespace scan_image_slam {
namespace {

/// Number of equal steps on each side that are no longer than `step` and end on the border.
int StepsToBorder(double half, double step) {
  return half > 0.0 ? static_cast<int>(std::ceil(half / step)) : 0;
}

/// The fraction first: it is exactly one at the border.
double At(double half, int index, int steps) {
  return steps == 0 ? 0.0 : half * (static_cast<double>(index) / steps);
}

}  // namespace

void SearchGrid::Validate() const {
  const auto require = [](bool ok, const char* name) {
    if (!ok) throw std::invalid_argument(std::string(name) + " must be positive and finite");
  };
  require(std::isfinite(distance_step) && distance_step > 0.0, "distance_step");
  require(std::isfinite(angle_step) && angle_step > 0.0, "angle_step");
  require(std::isfinite(deviation_cost) && deviation_cost >= 0.0, "deviation_cost");
}

std::vector<Candidate> MakeCandidates(const SearchWindow& window, const SearchGrid& grid,
                                      bool search_lateral) {
  const int distances = StepsToBorder(window.half_distance, grid.distance_step);
  const int laterals = search_lateral ? StepsToBorder(window.half_lateral, grid.distance_step) : 0;
  const int angles = StepsToBorder(window.half_angle, grid.angle_step);
  std::vector<Candidate> candidates;
  candidates.reserve(static_cast<std::size_t>(2 * distances + 1) * (2 * laterals + 1) *
                     (2 * angles + 1));
  for (int a = -angles; a <= angles; ++a) {
    for (int d = -distances; d <= distances; ++d) {
      for (int l = -laterals; l <= laterals; ++l) {
        Candidate candidate;
        candidate.deviation = {At(window.half_distance, d, distances),
                               At(window.half_lateral, l, laterals),
                               At(window.half_angle, a, angles)};
        candidate.steps = std::abs(d) + std::abs(l) + std::abs(a);
        candidates.push_back(candidate);
      }
    }
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.steps < b.steps; });
  return candidates;
}

}  // namespace scan_image_slam
