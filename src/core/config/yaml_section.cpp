#include "scan_image_slam/core/config/yaml_section.h"

#include <cmath>
#include <fstream>
#include <iterator>
#include <locale>
#include <sstream>

namespace scan_image_slam {
namespace {

std::string PlaceIn(const std::string& file, int line) {
  return line < 0 ? file + ": " : file + ":" + std::to_string(line + 1) + ": ";
}

std::string Format(double value) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << value;
  return text.str();
}

YAML::Node Parse(const std::string& text, const std::string& file) {
  try {
    return YAML::Load(text);
  } catch (const YAML::ParserException& error) {
    throw YamlError(PlaceIn(file, error.mark.line) + error.msg);
  }
}

}  // namespace

YamlSection YamlSection::FromFile(const std::string& file) {
  std::ifstream stream(file);
  if (!stream) throw YamlError(file + ": cannot be opened");
  const std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (stream.bad()) throw YamlError(file + ": cannot be read");
  return FromText(text, file);
}

YamlSection YamlSection::FromText(const std::string& text, const std::string& file) {
  return {Parse(text, file), file, ""};
}

YamlSection::YamlSection(const YAML::Node& node, std::string file, std::string path)
    : node_(node), file_(std::move(file)), path_(std::move(path)) {
  if (!node_.IsMap()) FailAt(node_, path_, "must be a map of keys and values");
  std::set<std::string> seen;
  for (const auto& entry : node_) {
    const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "?";
    if (!seen.insert(key).second) FailAt(entry.first, PathOf(key), "is given twice");
  }
}

std::string YamlSection::PathOf(const std::string& key) const {
  if (path_.empty() || key.empty()) return path_ + key;
  return path_ + "." + key;
}

void YamlSection::FailAt(const YAML::Node& node, const std::string& path,
                         const std::string& reason) const {
  const std::string about = path.empty() ? "" : "key '" + path + "': ";
  throw YamlError(PlaceIn(file_, node.Mark().line) + about + reason);
}

void YamlSection::Fail(const std::string& key, const std::string& reason) const {
  const YAML::Node& map = node_;
  const YAML::Node value = key.empty() ? YAML::Node() : map[key];
  FailAt(value.IsDefined() && !value.IsNull() ? value : node_, PathOf(key), reason);
}

bool YamlSection::Has(const std::string& key) const {
  const YAML::Node& map = node_;  // operator[] of a mutable node would add the key
  return map[key].IsDefined();
}

YAML::Node YamlSection::Find(const std::string& key) {
  read_.insert(key);
  const YAML::Node& map = node_;
  return map[key];
}

YAML::Node YamlSection::Require(const std::string& key) {
  if (!Has(key)) FailAt(node_, PathOf(key), "is missing");
  return Find(key);
}

double YamlSection::ToNumber(const YAML::Node& node, const std::string& path, double low,
                             double high) const {
  double value = 0.0;
  if (!node.IsScalar() || !YAML::convert<double>::decode(node, value) || !std::isfinite(value)) {
    FailAt(node, path, "must be a number");
  }
  if (value < low || value > high) {
    FailAt(node, path,
           "is " + Format(value) + ", must be in [" + Format(low) + ", " + Format(high) + "]");
  }
  return value;
}

void YamlSection::RequireList(const YAML::Node& node, const std::string& path) const {
  if (!node.IsSequence()) FailAt(node, path, "must be a list");
}

std::vector<double> YamlSection::ToNumbers(const YAML::Node& node, const std::string& path,
                                           std::size_t size, double low, double high) const {
  if (!node.IsSequence() || node.size() != size) {
    FailAt(node, path, "must be a list of " + std::to_string(size) + " numbers");
  }
  std::vector<double> values;
  for (const auto& item : node) values.push_back(ToNumber(item, path, low, high));
  return values;
}

double YamlSection::Number(const std::string& key, double low, double high) {
  return ToNumber(Require(key), PathOf(key), low, high);
}

double YamlSection::Number(const std::string& key, double low, double high, double fallback) {
  return Has(key) ? Number(key, low, high) : fallback;
}

int YamlSection::Integer(const std::string& key, int low, int high) {
  const YAML::Node node = Require(key);
  const double value = ToNumber(node, PathOf(key), low, high);
  if (value != std::floor(value)) FailAt(node, PathOf(key), "must be a whole number");
  return static_cast<int>(value);
}

int YamlSection::Integer(const std::string& key, int low, int high, int fallback) {
  return Has(key) ? Integer(key, low, high) : fallback;
}

bool YamlSection::Flag(const std::string& key, bool fallback) {
  if (!Has(key)) return fallback;
  const YAML::Node node = Require(key);
  bool value = false;
  if (!node.IsScalar() || !YAML::convert<bool>::decode(node, value)) {
    FailAt(node, PathOf(key), "must be true or false");
  }
  return value;
}

std::string YamlSection::Text(const std::string& key) {
  const YAML::Node node = Require(key);
  if (!node.IsScalar() || node.Scalar().empty()) FailAt(node, PathOf(key), "must be a text");
  return node.Scalar();
}

std::string YamlSection::Text(const std::string& key, const std::string& fallback) {
  return Has(key) ? Text(key) : fallback;
}

std::size_t YamlSection::Choice(const std::string& key, const std::vector<std::string>& names,
                                std::size_t fallback) {
  if (!Has(key)) return fallback;
  const std::string text = Text(key);
  std::string allowed;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == text) return i;
    allowed += (i == 0 ? "" : ", ") + names[i];
  }
  Fail(key, "is '" + text + "', must be one of: " + allowed);
}

std::vector<double> YamlSection::NumberOrNumbers(const std::string& key, double low, double high) {
  const YAML::Node node = Require(key);
  if (!node.IsSequence()) return {ToNumber(node, PathOf(key), low, high)};
  if (node.size() == 0) FailAt(node, PathOf(key), "must not be empty");
  return ToNumbers(node, PathOf(key), node.size(), low, high);
}

std::vector<double> YamlSection::Numbers(const std::string& key, std::size_t size, double low,
                                         double high) {
  return ToNumbers(Require(key), PathOf(key), size, low, high);
}

Eigen::Vector2d YamlSection::Point(const std::string& key) {
  constexpr double kFarthest = 1e4;
  const std::vector<double> values = Numbers(key, 2, -kFarthest, kFarthest);
  return {values[0], values[1]};
}

Eigen::Vector2d YamlSection::Point(const std::string& key, const Eigen::Vector2d& fallback) {
  return Has(key) ? Point(key) : fallback;
}

std::vector<std::vector<double>> YamlSection::Table(const std::string& key, std::size_t size,
                                                    double low, double high) {
  const YAML::Node node = Require(key);
  RequireList(node, PathOf(key));
  std::vector<std::vector<double>> rows;
  for (const auto& item : node) {
    const std::string path = PathOf(key) + "[" + std::to_string(rows.size()) + "]";
    rows.push_back(ToNumbers(item, path, size, low, high));
  }
  return rows;
}

std::vector<std::string> YamlSection::Texts(const std::string& key) {
  std::vector<std::string> texts;
  if (!Has(key)) return texts;
  const YAML::Node node = Require(key);
  RequireList(node, PathOf(key));
  for (const auto& item : node) {
    if (!item.IsScalar()) FailAt(item, PathOf(key), "must be a list of texts");
    texts.push_back(item.Scalar());
  }
  return texts;
}

YamlSection YamlSection::Child(const std::string& key) {
  if (!Has(key)) return {YAML::Node(YAML::NodeType::Map), file_, PathOf(key)};
  return {Require(key), file_, PathOf(key)};
}

std::vector<YamlSection> YamlSection::Children(const std::string& key) {
  std::vector<YamlSection> sections;
  if (!Has(key)) return sections;
  const YAML::Node node = Require(key);
  RequireList(node, PathOf(key));
  for (const auto& item : node) {
    sections.push_back({item, file_, PathOf(key) + "[" + std::to_string(sections.size()) + "]"});
  }
  return sections;
}

void YamlSection::Done() const {
  for (const auto& entry : node_) {
    const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "?";
    if (read_.count(key) == 0) FailAt(entry.first, PathOf(key), "is not known");
  }
}

}  // namespace scan_image_slam
