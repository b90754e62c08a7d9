#pragma once

#include "scan_image_slam/core/mapping/occupancy_grid.h"

#include <string>

#include <nav_msgs/OccupancyGrid.h>
#include <ros/node_handle.h>

namespace scan_image_slam {

/// Publishes a grid: `map` (latched) and `map_metadata`, and `map_updates` with what has changed.
class MapPublisher {
 public:
  MapPublisher(ros::NodeHandle node, std::string map_frame);

  /// Publishes what has changed since the last call, if anything.
  void Publish(OccupancyGrid* grid, const ros::Time& stamp);

  /// The next grid is another one: nothing of the last is left.
  void StartOver();

  /// The whole grid as it is now.
  const nav_msgs::OccupancyGrid& Current(OccupancyGrid* grid, const ros::Time& stamp);

 private:
  bool Refresh(OccupancyGrid* grid, const ros::Time& stamp);

  std::string map_frame_;
  ros::Publisher map_publisher_;
  ros::Publisher metadata_publisher_;
  ros::Publisher updates_publisher_;
  nav_msgs::OccupancyGrid map_;
  CellBox box_;
  CellBox changed_;       ///< since the last publication
  bool resized_ = false;  ///< since the last publication
};

}  // namespace scan_image_slam
