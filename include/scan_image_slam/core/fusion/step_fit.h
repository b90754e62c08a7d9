#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace scan_image_slam {

/// Grey levels along a row, one per column.
struct GreyProfile {
  int first_column = 0;
  std::vector<double> levels;  ///< [grey levels]
  double stddev = 1.0;         ///< of a level [grey levels]
};

/// A step of brightness in a profile.
struct StepFit {
  double column = 0.0;  ///< [px]
  double stddev =
      0.0;  ///< of the column, greater where the model does not explain the profile [px]
  double height = 0.0;  ///< from left to right [grey levels]
};

constexpr std::size_t kMostSteps = 5;  ///< that are fitted at once

/// Finds where the first of some steps is, by least squares of an even slope and all the steps,
/// blurred alike, so that near ones do not push each other aside. `columns`: about where they are
/// [px], at most kMostSteps. Nothing if the profile is too short or has no such step there.
std::optional<StepFit> FitFirstStep(const GreyProfile& profile, const std::vector<double>& columns);

}  // namespace scan_image_slam
