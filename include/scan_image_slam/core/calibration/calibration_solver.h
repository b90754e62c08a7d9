#pragma once

#include "scan_image_slam/core/calibration/coarse_search.h"
#include "scan_image_slam/core/calibration/jump_sight.h"

#include <array>
#include <string>

namespace scan_image_slam {

struct CalibrationSolverOptions {
  CoarseSearchOptions search;
  int search_views = 400;      ///< of the drive, for the search
  int min_pairs = 200;         ///< fewer say too little
  double min_over_chance = 2;  ///< pairs, relative to those that chance would make
  double final_gate = 0.004;   ///< between edge and discontinuity [rad]
  double block = 2.0;          ///< pairs of such a time may err together [s]
};

/// One quantity, as a correction to what was assumed.
struct CalibrationQuantity {
  double correction = 0.0;  ///< [rad], [m] or [s]; 0 if refused
  double stddev = 0.0;
  std::string refusal;  ///< why it is not observable; empty if it is
};

struct CalibrationResult {
  std::string refusal;  ///< why nothing can be said; empty if something can
  std::array<CalibrationQuantity, kCalibrationSize> quantities;
  int views = 0;            ///< with both edges and discontinuities
  int pairs = 0;            ///< of an edge and a discontinuity
  double by_chance = 0.0;   ///< pairs that one would expect at a wrong yaw
  double rms_before = 0.0;  ///< of the pairs' bearings, by what was assumed [px]
  double rms_after = 0.0;   ///< by the result [px]

  /// Corrections of what is observable.
  CalibrationVector Correction() const;
};

/// Finds the place of the camera at which the edges of the pictures lie on the discontinuities of
/// the scans (robust least squares). Only what is observable is corrected.
CalibrationResult Calibrate(const CalibrationData& data, const CalibrationSolverOptions& options);

}  // namespace scan_image_slam
