#pragma once

#include "scan_image_slam/core/simulation/drive_simulator.h"
#include "scan_image_slam/core/simulation/robot_path.h"

#include <vector>

namespace scan_image_slam {

/// Drives like somebody with a joystick who sees where the robot really is: pure pursuit of a point
/// ahead on the path, slower in curves, turns on the spot between legs.
class PathFollower {
 public:
  /// Throws std::invalid_argument if the path cannot be driven.
  explicit PathFollower(const RobotPath& path);

  /// What to do now. To be called in the order of time.
  Velocity Command(const TrueState& state);

  bool done() const { return leg_ >= legs_.size(); }

  /// Part of the path that is driven, 0 to 1.
  double share() const;

 private:
  Velocity Turn(const TrueState& state, const PathLeg& leg);
  Velocity Follow(const TrueState& state, const PathLeg& leg);

  RobotPath path_;
  std::vector<PathLeg> legs_;
  std::size_t leg_ = 0;
  std::size_t progress_ = 0;  // nearest sample of the leg
  bool turned_ = false;       // towards the leg
};

}  // namespace scan_image_slam
