#pragma once

#include <mutex>
#include <string>

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>
#include <ros/wall_timer.h>

namespace scan_image_slam {

/// Asks the master now and then whether it still knows this node. It forgets all nodes when it is
/// started anew, and roscpp does not notice. A thread of its own asks, as no answer may come for
/// minutes where the link to another machine is cut.
class MasterWatch {
 public:
  explicit MasterWatch(ros::NodeHandle node);
  ~MasterWatch();
  MasterWatch(const MasterWatch&) = delete;
  MasterWatch& operator=(const MasterWatch&) = delete;

  /// What was wrong when it was last asked, and what to do; empty if nothing was.
  std::string Problem() const;

 private:
  void Ask();

  mutable std::mutex mutex_;
  std::string problem_;
  ros::CallbackQueue queue_;
  ros::AsyncSpinner spinner_;
  ros::WallTimer timer_;
};

}  // namespace scan_image_slam
