#include "slam_status.h"

namespace scan_image_slam {
namespace {

constexpr double kSilence = 3.0;  // without diagnostics, which come every second [s]

}  // namespace

SlamStatus::SlamStatus(const std::string& name_space)
    : nodes_{{"scan_image_fusion", {}}, {"bounded_icp", {}}, {"mapper", {}}} {
  const std::size_t begin = name_space.find_first_not_of('/');
  if (begin != std::string::npos) prefix_ = name_space.substr(begin) + "/";
}

void SlamStatus::Take(const diagnostic_msgs::DiagnosticArray& message, ros::WallTime now) {
  for (const diagnostic_msgs::DiagnosticStatus& status : message.status) {
    for (auto& [name, node] : nodes_) {
      if (status.name == prefix_ + name + ": inputs") node = {status, now};
    }
  }
}

std::string SlamStatus::Activity(ros::WallTime now) const {
  if (Silent("mapper", now)) return "no mapper is heard";
  std::string text = Value("mapper", "mode");
  if (paused()) text += " (paused)";
  if (!Silent("bounded_icp", now)) text += "; sensors: " + Value("bounded_icp", "mode");
  return text;
}

std::string SlamStatus::Problems(ros::WallTime now) const {
  std::string text;
  for (const auto& [name, node] : nodes_) {
    const bool silent = Silent(name, now);
    if (!silent && node.status.level == diagnostic_msgs::DiagnosticStatus::OK) continue;
    if (!text.empty()) text += "\n";
    text += name + ": " +
            (silent ? "says nothing in /diagnostics; start it, e.g. by slam.launch"
                    : node.status.message);
  }
  return text;
}

bool SlamStatus::Silent(const std::string& node, ros::WallTime now) const {
  const ros::WallTime heard = nodes_.at(node).heard;
  return heard.isZero() || (now - heard).toSec() > kSilence;
}

std::string SlamStatus::Value(const std::string& node, const std::string& key) const {
  for (const diagnostic_msgs::KeyValue& value : nodes_.at(node).status.values) {
    if (value.key == key) return value.value;
  }
  return "";
}

}  // namespace scan_image_slam
