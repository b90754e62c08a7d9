#pragma once

#include "scan_image_slam/core/simulation/base_options.h"
#include "scan_image_slam/core/simulation/camera_options.h"
#include "scan_image_slam/core/simulation/fault.h"
#include "scan_image_slam/core/simulation/laser_options.h"
#include "scan_image_slam/core/simulation/robot_path.h"
#include "scan_image_slam/core/simulation/world.h"

#include <string>
#include <vector>

namespace scan_image_slam {

/// A world with a robot in it, as a file of config/worlds describes them.
struct Scenario {
  World world;
  std::vector<RobotPath> paths;  ///< at least one; the first is driven unless another is asked for
  LaserSimulatorOptions laser;
  CameraSimulatorOptions camera;
  BaseSimulatorOptions base;
  std::vector<Fault> faults;
};

/// Reads a world file and the files that it includes. Throws YamlError, whose message names file,
/// line and key.
Scenario LoadScenario(const std::string& file);

/// The path of that name, or the first one if `name` is empty. Throws std::invalid_argument that
/// lists the names if there is none.
const RobotPath& FindPath(const Scenario& scenario, const std::string& name);

}  // namespace scan_image_slam
