#include "scan_image_slam/ros/live_parameters.h"

#include <limits>
#include <stdexcept>
#include <utility>
#include <variant>

#include <dynamic_reconfigure/ConfigDescription.h>
#include <ros/console.h>

namespace scan_image_slam {
namespace {

constexpr const char* kGroup =
    "Default";  // the name that dynamic_reconfigure gives the first group

template <typename Item, typename Value>
Item MakeItem(const std::string& name, const Value& value) {
  Item item;
  item.name = name;
  item.value = value;
  return item;
}

void Add(const std::string& name, const ParameterValue& value,
         dynamic_reconfigure::Config* config) {
  using namespace dynamic_reconfigure;
  if (const bool* b = std::get_if<bool>(&value)) {
    config->bools.push_back(MakeItem<BoolParameter>(name, *b));
  } else if (const int* i = std::get_if<int>(&value)) {
    config->ints.push_back(MakeItem<IntParameter>(name, *i));
  } else if (const double* d = std::get_if<double>(&value)) {
    config->doubles.push_back(MakeItem<DoubleParameter>(name, *d));
  } else {
    config->strs.push_back(MakeItem<StrParameter>(name, std::get<std::string>(value)));
  }
}

/// A bound in the parameter's type. Clients draw no slider to infinity.
ParameterValue Bound(const Parameter& p, bool upper) {
  const double bound = upper ? p.range.max : p.range.min;
  if (p.type == "bool") return upper;
  if (p.type == "string") return std::string();
  if (p.type == "int") return static_cast<int>(bound);
  if (bound >= kUnlimited) return std::numeric_limits<double>::infinity();
  if (bound <= -kUnlimited) return -std::numeric_limits<double>::infinity();
  return bound;
}

/// The choices as clients read them, which is Python.
std::string EditMethod(const Parameter& p) {
  if (p.choices.empty()) return "";
  std::string items;
  for (const std::string& choice : p.choices) {
    items +=
        "{'name': '" + choice + "', 'value': '" + choice + "', 'type': 'str', 'description': ''}, ";
  }
  return "{'enum_description': '', 'enum': [" + items + "]}";
}

dynamic_reconfigure::GroupState OpenGroup() {
  dynamic_reconfigure::GroupState group;
  group.name = kGroup;
  group.state = true;
  return group;
}

/// What `value_of` gives for each live parameter.
template <typename ValueOf>
dynamic_reconfigure::Config MakeConfig(const ParameterSet& set, const ValueOf& value_of) {
  dynamic_reconfigure::Config config;
  for (const Parameter& p : set.parameters()) {
    if (p.live) Add(p.name, value_of(p), &config);
  }
  config.groups.push_back(OpenGroup());
  return config;
}

dynamic_reconfigure::Config ValuesOf(const ParameterSet& set) {
  return MakeConfig(set, [](const Parameter& p) { return p.get(); });
}

dynamic_reconfigure::ConfigDescription Describe(const ParameterSet& defaults) {
  dynamic_reconfigure::Group group;
  group.name = kGroup;
  for (const Parameter& p : defaults.parameters()) {
    if (!p.live) continue;
    dynamic_reconfigure::ParamDescription one;
    one.name = p.name;
    one.type = p.type == "string" ? "str" : p.type;
    one.description = p.description + (p.unit == "-" ? "" : " [" + p.unit + "]");
    one.edit_method = EditMethod(p);
    group.parameters.push_back(one);
  }
  dynamic_reconfigure::ConfigDescription description;
  description.groups.push_back(group);
  description.dflt = ValuesOf(defaults);
  description.min = MakeConfig(defaults, [](const Parameter& p) { return Bound(p, false); });
  description.max = MakeConfig(defaults, [](const Parameter& p) { return Bound(p, true); });
  return description;
}

}  // namespace

LiveParameters::LiveParameters(ros::NodeHandle private_node, const ParameterSet& defaults,
                               ParameterSet current, Take take)
    : private_node_(private_node), current_(std::move(current)), take_(std::move(take)) {
  current_.set_node(private_node.getNamespace());
  description_publisher_ = private_node.advertise<dynamic_reconfigure::ConfigDescription>(
      "parameter_descriptions", 1, true);
  update_publisher_ =
      private_node.advertise<dynamic_reconfigure::Config>("parameter_updates", 1, true);
  description_publisher_.publish(Describe(defaults));
  update_publisher_.publish(ValuesOf(current_));
  service_ = private_node.advertiseService("set_parameters", &LiveParameters::OnRequest, this);
}

LiveParameters::Values LiveParameters::Checked(const dynamic_reconfigure::Config& config,
                                               const ParameterSet& set) {
  Values values;
  const auto check = [&](const std::string& name, const ParameterValue& value) {
    if (!set.Get(name).live) {
      throw ParameterError(set.node() + "/" + name +
                           ": can't be changed while the node runs; set it before the start");
    }
    values[name] = set.Checked(name, value);
  };
  for (const auto& item : config.bools) check(item.name, item.value != 0);
  for (const auto& item : config.ints) check(item.name, item.value);
  for (const auto& item : config.doubles) check(item.name, item.value);
  for (const auto& item : config.strs) check(item.name, item.value);
  return values;
}

/// A request that is refused fails, so that the client knows; why, is told on the console.
bool LiveParameters::OnRequest(dynamic_reconfigure::ReconfigureRequest& request,
                               dynamic_reconfigure::ReconfigureResponse& response) {
  try {
    const Values values = Checked(request.config, current_);
    take_(values);
    for (const auto& [name, value] : values) {
      // For who looks it up, and for the node if it has to be started anew.
      std::visit([&, &key = name](const auto& v) { private_node_.setParam(key, v); }, value);
      ROS_INFO_STREAM(current_.node() << "/" << name << " is now " << ToText(value));
    }
  } catch (const ParameterError& error) {
    ROS_ERROR_STREAM(error.what() << "; nothing was changed");
    return false;
  } catch (const std::invalid_argument& error) {
    ROS_ERROR_STREAM(current_.node() << "/" << error.what() << "; nothing was changed");
    return false;
  }
  response.config = ValuesOf(current_);
  update_publisher_.publish(response.config);
  return true;
}

}  // namespace scan_image_slam
