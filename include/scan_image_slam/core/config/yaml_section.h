#pragma once

#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <yaml-cpp/yaml.h>

namespace scan_image_slam {

/// A file that cannot be used. The message begins with `file:line: key 'path.to.key': `.
class YamlError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Strict reader of one yaml map: every key must be read before Done(), and a missing key, a wrong
/// type, a value out of range or a key given twice throws YamlError. Bounds are inclusive.
class YamlSection {
 public:
  /// Reads a file whose top level is a map.
  static YamlSection FromFile(const std::string& file);
  /// The same from text, for tests; `file` is the name for errors.
  static YamlSection FromText(const std::string& text, const std::string& file);

  bool Has(const std::string& key) const;

  double Number(const std::string& key, double low, double high);
  double Number(const std::string& key, double low, double high, double fallback);
  int Integer(const std::string& key, int low, int high);
  int Integer(const std::string& key, int low, int high, int fallback);
  bool Flag(const std::string& key, bool fallback);
  std::string Text(const std::string& key);
  std::string Text(const std::string& key, const std::string& fallback);
  /// Index of the value in `names`.
  std::size_t Choice(const std::string& key, const std::vector<std::string>& names,
                     std::size_t fallback);
  /// One number, or a list of at least one.
  std::vector<double> NumberOrNumbers(const std::string& key, double low, double high);
  /// A list of exactly `size` numbers.
  std::vector<double> Numbers(const std::string& key, std::size_t size, double low, double high);
  /// [x, y] in metres.
  Eigen::Vector2d Point(const std::string& key);
  Eigen::Vector2d Point(const std::string& key, const Eigen::Vector2d& fallback);
  /// [[...], [...], ...]: a list of lists of `size` numbers each.
  std::vector<std::vector<double>> Table(const std::string& key, std::size_t size, double low,
                                         double high);
  /// A list of texts.
  std::vector<std::string> Texts(const std::string& key);
  /// A map below this one; empty and valid if the key is absent.
  YamlSection Child(const std::string& key);
  /// A list of maps; empty if the key is absent.
  std::vector<YamlSection> Children(const std::string& key);

  /// Throws for the first key that nobody has read.
  void Done() const;
  /// Throws YamlError about a key of this section (about the section if `key` is empty).
  [[noreturn]] void Fail(const std::string& key, const std::string& reason) const;

  const std::string& file() const { return file_; }

 private:
  YamlSection(const YAML::Node& node, std::string file, std::string path);
  YAML::Node Find(const std::string& key);
  YAML::Node Require(const std::string& key);
  [[noreturn]] void FailAt(const YAML::Node& node, const std::string& path,
                           const std::string& reason) const;
  std::string PathOf(const std::string& key) const;
  double ToNumber(const YAML::Node& node, const std::string& path, double low, double high) const;
  std::vector<double> ToNumbers(const YAML::Node& node, const std::string& path, std::size_t size,
                                double low, double high) const;
  void RequireList(const YAML::Node& node, const std::string& path) const;

  YAML::Node node_;
  std::string file_;
  std::string path_;
  std::set<std::string> read_;
};

}  // namespace scan_image_slam
