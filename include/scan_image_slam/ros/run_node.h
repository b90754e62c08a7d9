#pragma once

#include "scan_image_slam/ros/memory_limit.h"

#include <csignal>
#include <exception>
#include <memory>
#include <new>

#include <ros/console.h>
#include <ros/init.h>
#include <ros/node_handle.h>

namespace scan_image_slam {

/// Holds Ctrl-C and the like back while a node is being made: roscpp aborts if it has to shut down
/// half of one.
class InterruptLater {
 public:
  InterruptLater() {
    sigset_t interrupt;
    sigemptyset(&interrupt);
    sigaddset(&interrupt, SIGINT);
    sigaddset(&interrupt, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &interrupt, &before_);
  }
  ~InterruptLater() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  InterruptLater(const InterruptLater&) = delete;
  InterruptLater& operator=(const InterruptLater&) = delete;

 private:
  sigset_t before_;
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
    std::unique_ptr<Node> instance;
    {
      const InterruptLater interrupt_later;
      instance = std::make_unique<Node>(node, private_node);
    }
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
