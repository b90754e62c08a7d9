#pragma once

#include <cstdio>
#include <exception>

#include <ros/console.h>
#include <ros/init.h>
#include <ros/node_handle.h>

namespace scan_image_slam {

/// main() of a node: spins until it is shut down. A wrong configuration ends it at once, with the
/// reason and exit code 1.
template <typename Node>
int RunNode(int argc, char** argv, const char* name) {
  ros::init(argc, argv, name);
  ros::NodeHandle node;
  ros::NodeHandle private_node("~");
  try {
    Node instance(node, private_node);
    ros::spin();
    return 0;
  } catch (const std::exception& error) {
    ROS_FATAL_STREAM(error.what());
    return 1;
  }
}

}  // namespace scan_image_slam
