#pragma once

#include "bag_plan.h"

#include <string>
#include <vector>

namespace scan_image_slam {

/// Topics and options of a plan, as slam_offline would get them from its command line.
BagTopics PlannedTopics(const BagPlan& plan);
SlamOptions PlannedOptions(const BagPlan& plan);

/// Lines for the shell that map with a bag as planned, in the order in which they are to be run.
/// `slam_offline`: how the program is called, e.g. `rosrun scan_image_slam slam_offline`.
std::vector<std::string> CommandLines(const BagContents& contents, const BagPlan& plan,
                                      const std::string& slam_offline);

}  // namespace scan_image_slam
