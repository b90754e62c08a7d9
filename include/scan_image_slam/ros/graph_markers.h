#pragma once

#include "scan_image_slam/core/mapping/back_end_thread.h"

#include <string>

#include <visualization_msgs/MarkerArray.h>

namespace scan_image_slam {

/// The pose graph for rviz: keyframes as dots, the way between them and the recognised places as
/// lines.
visualization_msgs::MarkerArray ToMarkers(const GraphState& graph, const std::string& map_frame,
                                          const ros::Time& stamp);

}  // namespace scan_image_slam
