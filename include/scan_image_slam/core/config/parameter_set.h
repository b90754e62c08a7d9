#pragma once

#include <functional>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace scan_image_slam {

/// A parameter as a yaml file or the parameter server holds it.
using ParameterValue = std::variant<bool, int, double, std::string>;

/// A parameter that can't be used; the message starts with its full name.
class ParameterError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A bound so far away that there is none, for those who read of it.
constexpr double kUnlimited = 1e9;

/// Closed interval that a number must lie in.
struct ParameterRange {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
};

/// One parameter: its name, what it means, and where its value is kept.
struct Parameter {
  std::string name;                  ///< relative to the node, e.g. window/min_distance
  std::string type;                  ///< bool, int, double or string
  std::string unit;                  ///< "-" for none
  ParameterRange range;              ///< for numbers
  std::vector<std::string> choices;  ///< for strings; empty: any
  std::string description;
  std::function<ParameterValue()> get;
  std::function<void(const ParameterValue&)> set;  ///< type and range are already checked
  bool live = false;                               ///< may change while the node runs
};

/// What values a parameter may have, in words: "positive", "0.0 to 1.0", "one, two"; empty: any.
std::string RangeText(const Parameter& parameter);

/// The parameters of one node. Each points to a field of an options struct, whose initial value is
/// the default: there is no other place for it.
class ParameterSet {
 public:
  /// `node` is the prefix of full names in messages.
  explicit ParameterSet(std::string node) : node_(std::move(node)) {}

  void Add(const std::string& name, bool* target, const std::string& description);
  void Add(const std::string& name, int* target, const std::string& unit, ParameterRange range,
           const std::string& description);
  void Add(const std::string& name, double* target, const std::string& unit, ParameterRange range,
           const std::string& description);
  void Add(const std::string& name, std::string* target, const std::string& description);
  /// An angle kept in radians and told in degrees; `name` ends in _deg, the range is in degrees.
  void AddDegrees(const std::string& name, double* target_rad, ParameterRange range,
                  const std::string& description);
  /// One of several named values.
  template <typename Enum>
  void AddChoice(const std::string& name, Enum* target,
                 const std::vector<std::pair<std::string, Enum>>& choices,
                 const std::string& description);

  /// Parameters that may change while the node runs: names, or groups, with a slash at their end.
  void AllowLive(const std::vector<std::string>& names);

  /// Whether there is a parameter of this name.
  bool Has(const std::string& name) const;
  /// Throws ParameterError if there is none.
  const Parameter& Get(const std::string& name) const;

  /// The value in the parameter's type. Throws ParameterError if the parameter is unknown, of
  /// another type or out of range.
  ParameterValue Checked(const std::string& name, const ParameterValue& value) const;
  /// Sets the field that a parameter points to, to its checked value.
  void Set(const std::string& name, const ParameterValue& value) const;
  /// Sets several, by name; stops at the first that is wrong.
  void Set(const std::map<std::string, ParameterValue>& values) const;

  /// The parameters whose values, as text, are not those of the same parameters in `other`.
  ParameterSet DifferentFrom(const ParameterSet& other) const;

  const std::string& node() const { return node_; }
  /// For a node that runs under another name.
  void set_node(const std::string& node) { node_ = node; }
  const std::vector<Parameter>& parameters() const { return parameters_; }

 private:
  std::string FullName(const std::string& name) const { return node_ + "/" + name; }

  std::string node_;
  std::vector<Parameter> parameters_;
};

/// The value as yaml text.
std::string ToText(const ParameterValue& value);

template <typename Enum>
void ParameterSet::AddChoice(const std::string& name, Enum* target,
                             const std::vector<std::pair<std::string, Enum>>& choices,
                             const std::string& description) {
  Parameter p;
  p.name = name;
  p.type = "string";
  p.unit = "-";
  p.description = description;
  for (const auto& choice : choices) p.choices.push_back(choice.first);
  p.get = [target, choices]() -> ParameterValue {
    for (const auto& choice : choices) {
      if (choice.second == *target) return choice.first;
    }
    return std::string();
  };
  p.set = [target, choices](const ParameterValue& value) {
    for (const auto& choice : choices) {
      if (choice.first == std::get<std::string>(value)) *target = choice.second;
    }
  };
  parameters_.push_back(std::move(p));
}

}  // namespace scan_image_slam
