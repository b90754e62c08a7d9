#pragma once

#include "scan_image_slam/core/config/parameter_set.h"

#include <functional>
#include <map>
#include <string>

#include <dynamic_reconfigure/Reconfigure.h>
#include <ros/node_handle.h>

namespace scan_image_slam {

/// Lets users change parameters while the node runs, with rqt_reconfigure, dynparam and whatever
/// else speaks the messages of dynamic_reconfigure. What is offered, with default, range and
/// meaning, comes from the node's ParameterSet: there is no other description of it.
class LiveParameters {
 public:
  using Values = std::map<std::string, ParameterValue>;
  /// Takes over checked values, all of them, from the next message on; or throws
  /// std::invalid_argument, and takes over none, if they do not fit each other.
  using Take = std::function<void(const Values&)>;

  /// `current` must tell the values in use, at any time.
  LiveParameters(ros::NodeHandle private_node, const ParameterSet& defaults, ParameterSet current,
                 Take take);

  /// What a request asks for. Throws ParameterError if a parameter of it is not in the set, can't
  /// be changed now, or has another type or range.
  static Values Checked(const dynamic_reconfigure::Config& config, const ParameterSet& set);

 private:
  bool OnRequest(dynamic_reconfigure::ReconfigureRequest& request,
                 dynamic_reconfigure::ReconfigureResponse& response);

  ros::NodeHandle private_node_;
  ParameterSet current_;
  Take take_;
  ros::Publisher description_publisher_;
  ros::Publisher update_publisher_;
  ros::ServiceServer service_;
};

}  // namespace scan_image_slam
