#include "scan_image_slam/core/config/parameter_set.h"

#include "scan_image_slam/core/config/foreign_names.h"
#include "scan_image_slam/core/config/text_similarity.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <locale>
#include <sstream>

namespace scan_image_slam {
namespace {

std::string TypeOf(const ParameterValue& value) {
  constexpr const char* kNames[] = {"bool", "int", "double", "string"};
  return kNames[value.index()];
}

/// Yaml takes a number without a point for a whole one, and 1e-05 for text.
std::string WithPoint(std::string number) {
  if (number.find_first_of(".n") != std::string::npos) return number;  // also inf and nan
  number.insert(std::min(number.find('e'), number.size()), ".0");
  return number;
}

/// The number that a text spells, as rosparam does not read 1e-5 as one.
bool ToNumber(const std::string& text, double* number) {
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  return static_cast<bool>(stream >> *number) && stream.eof();
}

std::string Join(const std::vector<std::string>& words) {
  std::string joined;
  for (const std::string& word : words) joined += (joined.empty() ? "" : ", ") + word;
  return joined;
}

void CheckRange(const std::string& full_name, double value, const ParameterRange& range) {
  if (std::isfinite(value) && value >= range.min && value <= range.max) return;
  throw ParameterError(full_name + ": " + ToText(value) + " is out of range, allowed are " +
                       ToText(range.min) + " to " + ToText(range.max));
}

}  // namespace

std::string ToText(const ParameterValue& value) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  if (const bool* b = std::get_if<bool>(&value)) {
    text << (*b ? "true" : "false");
  } else if (const int* i = std::get_if<int>(&value)) {
    text << *i;
  } else if (const double* d = std::get_if<double>(&value)) {
    text << std::setprecision(10) << *d;
    return WithPoint(text.str());
  } else {
    text << '"' << std::get<std::string>(value) << '"';
  }
  return text.str();
}

std::string RangeText(const Parameter& p) {
  if (p.type == "bool") return "";
  if (p.type == "string") return Join(p.choices);
  if (p.range.max < kUnlimited) return ToText(p.range.min) + " to " + ToText(p.range.max);
  if (p.range.min <= -kUnlimited) return "";
  return p.range.min > 0.0 ? "positive" : "not negative";
}

void ParameterSet::Add(const std::string& name, bool* target, const std::string& description) {
  parameters_.push_back({name,
                         "bool",
                         "-",
                         {},
                         {},
                         description,
                         [target]() -> ParameterValue { return *target; },
                         [target](const ParameterValue& v) { *target = std::get<bool>(v); }});
}

void ParameterSet::Add(const std::string& name, int* target, const std::string& unit,
                       ParameterRange range, const std::string& description) {
  parameters_.push_back({name,
                         "int",
                         unit,
                         range,
                         {},
                         description,
                         [target]() -> ParameterValue { return *target; },
                         [target](const ParameterValue& v) { *target = std::get<int>(v); }});
}

void ParameterSet::Add(const std::string& name, double* target, const std::string& unit,
                       ParameterRange range, const std::string& description) {
  parameters_.push_back({name,
                         "double",
                         unit,
                         range,
                         {},
                         description,
                         [target]() -> ParameterValue { return *target; },
                         [target](const ParameterValue& v) { *target = std::get<double>(v); }});
}

void ParameterSet::Add(const std::string& name, std::string* target,
                       const std::string& description) {
  parameters_.push_back(
      {name,
       "string",
       "-",
       {},
       {},
       description,
       [target]() -> ParameterValue { return *target; },
       [target](const ParameterValue& v) { *target = std::get<std::string>(v); }});
}

void ParameterSet::AddDegrees(const std::string& name, double* target_rad, ParameterRange range,
                              const std::string& description) {
  constexpr double kDegree = M_PI / 180.0;
  parameters_.push_back(
      {name,
       "double",
       "deg",
       range,
       {},
       description,
       // Rounded, so that a default of whole degrees is told as such.
       [target_rad]() -> ParameterValue { return std::round(*target_rad / kDegree * 1e9) / 1e9; },
       [target_rad](const ParameterValue& v) { *target_rad = std::get<double>(v) * kDegree; }});
}

void ParameterSet::AllowLive(const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    bool found = false;
    for (Parameter& p : parameters_) {
      const bool in_group = name.back() == '/' && p.name.rfind(name, 0) == 0;
      if (p.name != name && !in_group) continue;
      p.live = true;
      found = true;
    }
    if (!found) throw ParameterError(FullName(name) + ": there is nothing of this name");
  }
}

bool ParameterSet::Has(const std::string& name) const {
  return std::any_of(parameters_.begin(), parameters_.end(),
                     [&](const Parameter& p) { return p.name == name; });
}

const Parameter& ParameterSet::Get(const std::string& name) const {
  const auto found = std::find_if(parameters_.begin(), parameters_.end(),
                                  [&](const Parameter& p) { return p.name == name; });
  if (found != parameters_.end()) return *found;
  if (const ForeignName* foreign = FindForeignName(name)) {
    throw ParameterError(FullName(name) + ": " + Explain(*foreign));
  }
  std::vector<std::string> names;
  for (const Parameter& p : parameters_) names.push_back(p.name);
  throw ParameterError(FullName(name) + ": unknown parameter" +
                       (names.empty() ? "" : ", did you mean " + MostSimilar(name, names) + "?"));
}

ParameterValue ParameterSet::Checked(const std::string& name, const ParameterValue& value) const {
  const Parameter& p = Get(name);
  const std::string full_name = FullName(name);
  ParameterValue converted = value;
  if (p.type == "double" && std::holds_alternative<int>(value)) {
    converted = static_cast<double>(std::get<int>(value));
  }
  double number = 0.0;
  if (p.type == "double" && std::holds_alternative<std::string>(value) &&
      ToNumber(std::get<std::string>(value), &number)) {
    converted = number;
  }
  if (TypeOf(converted) != p.type) {
    throw ParameterError(full_name + ": " + ToText(value) + " is of type " + TypeOf(value) +
                         ", expected is " + p.type);
  }
  if (const int* i = std::get_if<int>(&converted)) CheckRange(full_name, *i, p.range);
  if (const double* d = std::get_if<double>(&converted)) CheckRange(full_name, *d, p.range);
  if (!p.choices.empty() && std::find(p.choices.begin(), p.choices.end(),
                                      std::get<std::string>(converted)) == p.choices.end()) {
    throw ParameterError(full_name + ": " + ToText(value) + " is not one of " + Join(p.choices));
  }
  return converted;
}

void ParameterSet::Set(const std::string& name, const ParameterValue& value) const {
  Get(name).set(Checked(name, value));
}

void ParameterSet::Set(const std::map<std::string, ParameterValue>& values) const {
  for (const auto& [name, value] : values) Set(name, value);
}

ParameterSet ParameterSet::DifferentFrom(const ParameterSet& other) const {
  ParameterSet different(node_);
  for (const Parameter& p : parameters_) {
    if (ToText(p.get()) != ToText(other.Get(p.name).get())) different.parameters_.push_back(p);
  }
  return different;
}

}  // namespace scan_image_slam
