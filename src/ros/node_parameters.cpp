#include "scan_image_slam/ros/node_parameters.h"

#include "scan_image_slam/core/config/foreign_names.h"

#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <XmlRpcValue.h>
#include <ros/console.h>
#include <ros/param.h>

namespace scan_image_slam {
namespace {

/// Names below ours that belong to the libraries we use: settings of image_transport, which are
/// kept below the topic of a picture or below the node, and the period of diagnostic_updater.
bool BelongsToLibrary(const std::string& name) {
  static const std::set<std::string> kNames = {"diagnostic_period", "mode",
                                               "post_processing_level"};
  static const std::set<std::string> kParts = {"compressed", "compressedDepth", "theora",
                                               "disable_pub_plugins", "enable_pub_plugins"};
  if (kNames.count(name) != 0) return true;
  std::istringstream parts(name);
  for (std::string part; std::getline(parts, part, '/');) {
    if (kParts.count(part) != 0) return true;
  }
  return false;
}

ParameterValue ToValue(const std::string& full_name, XmlRpc::XmlRpcValue& value) {
  switch (value.getType()) {
    case XmlRpc::XmlRpcValue::TypeBoolean:
      return static_cast<bool>(value);
    case XmlRpc::XmlRpcValue::TypeInt:
      return static_cast<int>(value);
    case XmlRpc::XmlRpcValue::TypeDouble:
      return static_cast<double>(value);
    case XmlRpc::XmlRpcValue::TypeString:
      return static_cast<std::string>(value);
    default:
      throw ParameterError(full_name + ": a single value is expected");
  }
}

}  // namespace

void ReadParameters(const ros::NodeHandle& private_node, ParameterSet* set) {
  const std::string prefix = private_node.getNamespace() + "/";
  set->set_node(private_node.getNamespace());
  std::vector<std::string> names;
  ros::param::getParamNames(names);
  for (const std::string& full_name : names) {
    if (full_name.rfind(prefix, 0) != 0) continue;
    const std::string name = full_name.substr(prefix.size());
    if (BelongsToLibrary(name)) continue;
    const ForeignName* foreign = set->Has(name) ? nullptr : FindForeignName(name);
    if (foreign != nullptr) {
      ROS_WARN_STREAM(full_name << ": " << Explain(*foreign));
      continue;
    }
    XmlRpc::XmlRpcValue value;
    if (!ros::param::get(full_name, value)) continue;  // deleted in the meantime
    set->Set(name, ToValue(full_name, value));
  }
}

}  // namespace scan_image_slam
