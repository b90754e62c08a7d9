#pragma once

#include <ros/callback_queue.h>
#include <ros/init.h>
#include <ros/time.h>

namespace scan_image_slam {

/// Spins until the condition holds; false if it does not within ten seconds.
template <typename Condition>
bool SpinUntil(const Condition& condition) {
  const ros::WallTime deadline = ros::WallTime::now() + ros::WallDuration(10.0);
  while (!condition() && ros::WallTime::now() < deadline) {
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.01));
  }
  return condition();
}

}  // namespace scan_image_slam
