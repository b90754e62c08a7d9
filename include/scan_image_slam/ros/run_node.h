#pragma once

#include "scan_image_slam/ros/memory_limit.h"

#include <atomic>
#include <csignal>
#include <exception>
#include <new>

#include <ros/console.h>
#include <ros/init.h>
#include <ros/node_handle.h>

namespace scan_image_slam {

/// Ctrl-C and the like, held back while a node is being made: roscpp aborts if it has to shut down
/// half of one. Whichever thread the system lets handle the signal.
class Interrupt {
 public:
  /// To be called once the first NodeHandle has made roscpp take its own handlers.
  static void HoldBack() {
    for (const int number : {SIGINT, SIGTERM}) std::signal(number, &Interrupt::Handle);
  }
  /// From now on it ends the node, also if it has come already.
  static void LetThrough() {
    held_back = false;
    if (pending) ros::requestShutdown();
  }

 private:
  static void Handle(int /*number*/) {
    pending = true;
    if (!held_back) ros::requestShutdown();
  }

  static inline std::atomic<bool> held_back{true};
  static inline std::atomic<bool> pending{false};
};

/// main() of a node: spins until it is shut down, by Ctrl-C or by SIGTERM, which roscpp leaves to
/// the system and which then would save nothing. A wrong configuration ends it at once, with the
/// reason and exit code 1, and so does more memory than LimitMemory() allows.
template <typename Node>
int RunNode(int argc, char** argv, const char* name) {
  ros::init(argc, argv, name);
  std::signal(SIGTERM, [](int) { ros::requestShutdown(); });
  ros::NodeHandle node;
  ros::NodeHandle private_node("~");
  std::size_t memory = 0;
  try {
    memory = LimitMemory();
    Interrupt::HoldBack();
    const Node instance(node, private_node);
    Interrupt::LetThrough();
    ros::spin();
    return 0;
  } catch (const std::bad_alloc&) {
    ROS_FATAL("more memory needed than the %zu MiB that a node may have", memory >> 20);
    return 1;
  } catch (const std::exception& error) {
    ROS_FATAL_STREAM(error.what());
    return 1;
  }
}

}  // namespace scan_image_slam
