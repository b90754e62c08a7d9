#include "scan_image_slam/ros/node_parameters.h"

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include <XmlRpcValue.h>
#include <ros/param.h>

namespace scan_image_slam {
namespace {

/// Names below ours that belong to the libraries we use.
bool BelongsToLibrary(const std::string& name) {
  const auto prefixes = {"image_raw/", "fusion/image/", "diagnostic_period"};
  return std::any_of(prefixes.begin(), prefixes.end(),
                     [&](const char* prefix) { return name.rfind(prefix, 0) == 0; });
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
  std::vector<std::string> names;
  ros::param::getParamNames(names);
  for (const std::string& full_name : names) {
    if (full_name.rfind(prefix, 0) != 0) continue;
    const std::string name = full_name.substr(prefix.size());
    if (BelongsToLibrary(name)) continue;
    XmlRpc::XmlRpcValue value;
    if (!ros::param::get(full_name, value)) continue;  // deleted in the meantime
    set->Set(name, ToValue(full_name, value));
  }
}

}  // namespace scan_image_slam
