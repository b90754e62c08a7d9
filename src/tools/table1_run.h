#pragma once

#include "scan_image_slam/core/baseline/core_slam.h"
#include "scan_image_slam/core/config/slam_parameters.h"
#include "scan_image_slam/core/evaluation/trajectory.h"
#include "scan_image_slam/core/simulation/scenario.h"

#include <functional>
#include <string>
#include <vector>

namespace scan_image_slam {

/// Side of a pixel of the map in which the paper's errors are told [m].
constexpr double kPixel = 0.05;

/// The proposed method in one configuration.
struct Table1Variant {
  std::string config;
  SlamOptions options;
  bool correct_sweep = true;  ///< false: the scans do not say when their beams were fired
};

/// One simulated run, which all methods get.
struct Table1Job {
  std::string map;
  int seed = 1;
  std::string sensors;    ///< realistic, ideal, or ideal_laser_camera (encoders keep their errors)
  double duration = 0.0;  ///< [s]
};

/// One line of the table: one method on one run.
struct Table1Row {
  Table1Job job;
  std::string method;
  std::string config;
  double error = 0.0;  ///< mean distance to the true position [m]
  double yaw = 0.0;    ///< mean heading error [rad]
  double fps = 0.0;    ///< scans per second of processor time
};

/// What a method made of a run.
struct Table1Estimate {
  Table1Row row;
  Trajectory trajectory;  ///< in the frame of the truth
};

struct Table1Result {
  Trajectory truth;
  std::vector<Table1Estimate> estimates;
};

/// Simulates a run and hands it to CoreSLAM and to each variant; the first variant must use all
/// beams, because CoreSLAM gets its scans as that variant's first stage reads them.
Table1Result RunTable1(const Table1Job& job, Scenario scenario,
                       const std::vector<Table1Variant>& variants, const CoreSlamOptions& core_slam,
                       const std::function<void(double)>& progress);

}  // namespace scan_image_slam
