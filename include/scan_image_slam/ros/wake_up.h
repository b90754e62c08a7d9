#pragma once

#include <functional>
#include <optional>

#include <ros/node_handle.h>
#include <ros/steady_timer.h>

namespace scan_image_slam {

/// Calls a function once, after a time that is set anew whenever it changes. Costs nothing while
/// there is nothing to wait for.
class WakeUp {
 public:
  WakeUp(const ros::NodeHandle& node, const std::function<void()>& call)
      : timer_(node.createSteadyTimer(
            ros::WallDuration(1.0), [call](const ros::SteadyTimerEvent&) { call(); },
            /*oneshot=*/true, /*autostart=*/false)) {}

  /// In so many seconds, instead of what was set before; never if there is none.
  void In(std::optional<double> seconds) {
    timer_.stop();
    if (!seconds) return;
    timer_.setPeriod(ros::WallDuration(*seconds > 0.0 ? *seconds : 1e-6));
    timer_.start();
  }

 private:
  ros::SteadyTimer timer_;
};

}  // namespace scan_image_slam
