#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include <boost/function.hpp>
#include <ros/advertise_service_options.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>

namespace scan_image_slam {

/// A thread for services that read and write files, beside the thread of a node, so that no scan
/// waits for them. Declare it after all that the services use.
class SideThread {
 public:
  explicit SideThread(const ros::NodeHandle& node);
  /// Ends the services. Call it where the thread of the node runs no callbacks any more.
  ~SideThread();
  SideThread(const SideThread&) = delete;
  SideThread& operator=(const SideThread&) = delete;

  template <typename Request, typename Response>
  void Advertise(const std::string& name,
                 const boost::function<bool(Request&, Response&)>& callback) {
    ros::AdvertiseServiceOptions options;
    options.init<Request, Response>(name, callback);
    options.callback_queue = &queue_;
    services_.push_back(node_.advertiseService(options));
  }

  /// Runs some short work in the thread of the node and waits for it; what it throws is thrown
  /// here. Throws std::runtime_error if the node ends before.
  void InNodeThread(const std::function<void()>& work);

 private:
  ros::NodeHandle node_;
  ros::CallbackQueue queue_;
  ros::AsyncSpinner spinner_{1, &queue_};
  std::vector<ros::ServiceServer> services_;
  std::atomic<bool> ends_{false};
};

}  // namespace scan_image_slam
