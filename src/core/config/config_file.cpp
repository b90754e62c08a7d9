#include "scan_image_slam/core/config/config_file.h"

#include <algorithm>
#include <ios>
#include <set>
#include <sstream>

#include <yaml-cpp/yaml.h>

namespace scan_image_slam {
namespace {

std::string At(const std::string& path, const YAML::Mark& mark) {
  return path + ":" + std::to_string(mark.line + 1) + ": ";
}

/// The name of an entry. Throws ParameterError if it is none, or one of `names` already.
std::string NameOf(const YAML::Node& key, const std::string& path, std::set<std::string>* names) {
  if (!key.IsScalar()) throw ParameterError(At(path, key.Mark()) + "a name is expected");
  const std::string& name = key.Scalar();
  if (!names->insert(name).second) {
    throw ParameterError(At(path, key.Mark()) + name + ": is there twice");
  }
  return name;
}

void Flatten(const YAML::Node& node, const std::string& prefix, const std::string& path,
             std::map<std::string, ParameterValue>* values) {
  std::set<std::string> names;
  for (const auto& item : node) {
    const std::string name = prefix + NameOf(item.first, path, &names);
    if (item.second.IsMap()) {
      Flatten(item.second, name + "/", path, values);
    } else if (item.second.IsScalar()) {
      // A quoted scalar carries the tag "!": it is text, whatever it looks like.
      const std::string& text = item.second.Scalar();
      (*values)[name] = item.second.Tag() == "!" ? ParameterValue(text) : ParseParameterValue(text);
    } else {
      throw ParameterError(At(path, item.first.Mark()) + name + ": a single value is expected");
    }
  }
}

/// Breaks a description into comment lines.
std::string Comment(const std::string& text, const std::string& indent) {
  constexpr std::size_t kWidth = 96;
  std::istringstream words(text);
  std::string word;
  std::string lines;
  std::string line = indent + "#";
  while (words >> word) {
    if (line.size() + 1 + word.size() > kWidth) {
      lines += line + "\n";
      line = indent + "#";
    }
    line += " " + word;
  }
  return lines + line + "\n";
}

std::string Describe(const Parameter& p) {
  std::string text = p.description;
  if (p.unit != "-") text += " [" + p.unit + "]";
  if (p.type != "string" && !RangeText(p).empty()) text += ", " + RangeText(p);
  return text;
}

}  // namespace

ParameterValue ParseParameterValue(const std::string& text) {
  std::string lower = text;
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : static_cast<char>(c);
  });
  if (lower == "true" || lower == "yes" || lower == "on") return true;
  if (lower == "false" || lower == "no" || lower == "off") return false;
  std::istringstream whole(text);
  whole.imbue(std::locale::classic());
  int i = 0;
  if (whole >> i && whole.eof()) return i;
  std::istringstream real(text);
  real.imbue(std::locale::classic());
  double d = 0.0;
  if (real >> d && real.eof()) return d;
  return text;
}

ConfigSections ReadConfigFile(const std::string& path) {
  ConfigSections sections;
  YAML::Node root;
  try {
    root = YAML::LoadFile(path);
  } catch (const YAML::BadFile&) {
    throw ParameterError("can't read the configuration " + path);
  } catch (const std::ios_base::failure&) {  // a folder
    throw ParameterError("can't read the configuration " + path);
  } catch (const YAML::ParserException& error) {
    throw ParameterError(At(path, error.mark) + error.msg);
  }
  if (root.IsNull()) return sections;
  if (!root.IsMap()) throw ParameterError(path + ": sections named after the nodes are expected");
  std::set<std::string> names;
  for (const auto& section : root) {
    const std::string node = NameOf(section.first, path, &names);
    if (section.second.IsNull()) continue;
    if (!section.second.IsMap()) {
      throw ParameterError(At(path, section.first.Mark()) + node + ": a section is expected");
    }
    Flatten(section.second, "", path, &sections[node]);
  }
  return sections;
}

void ApplyConfig(const ConfigSections& sections, const std::string& path,
                 std::vector<ParameterSet>* sets) {
  for (const auto& [node, values] : sections) {
    const auto set =
        std::find_if(sets->begin(), sets->end(),
                     [&name = node](const ParameterSet& s) { return s.node() == name; });
    if (set == sets->end()) throw ParameterError(path + ": there is no node " + node);
    try {
      set->Set(values);
    } catch (const ParameterError& error) {
      throw ParameterError(path + ": " + error.what());
    }
  }
}

std::string WriteConfig(const std::vector<ParameterSet>& sets) {
  std::string text;
  for (const ParameterSet& set : sets) {
    text += (text.empty() ? "" : "\n") + set.node() + ":\n";
    std::string group;
    for (const Parameter& p : set.parameters()) {
      const std::size_t slash = p.name.find('/');
      const std::string new_group = slash == std::string::npos ? "" : p.name.substr(0, slash);
      const std::string indent = new_group.empty() ? "  " : "    ";
      if (new_group != group && !new_group.empty()) text += "  " + new_group + ":\n";
      group = new_group;
      text += Comment(Describe(p), indent);
      text += indent + (group.empty() ? p.name : p.name.substr(slash + 1)) + ": " +
              ToText(p.get()) + "\n";
    }
  }
  return text;
}

}  // namespace scan_image_slam
