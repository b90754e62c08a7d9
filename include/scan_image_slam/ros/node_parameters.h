#pragma once

#include "scan_image_slam/core/config/parameter_set.h"

#include <ros/node_handle.h>

namespace scan_image_slam {

/// Sets what the parameter server holds below a node's private name. Throws ParameterError, with
/// the full name, if a parameter is unknown, of the wrong type or out of range. A name that is
/// known from another package is answered with a warning that says what to use instead. What
/// image_transport and diagnostic_updater keep there for themselves is left alone.
void ReadParameters(const ros::NodeHandle& private_node, ParameterSet* set);

}  // namespace scan_image_slam
