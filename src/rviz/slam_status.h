#pragma once

#include <map>
#include <string>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/time.h>

namespace scan_image_slam {

/// What the three nodes of one robot say of themselves in /diagnostics, in words for a panel.
class SlamStatus {
 public:
  /// `name_space`: of the nodes, such as "/" or "/robot1".
  explicit SlamStatus(const std::string& name_space);

  /// Statuses of others are passed over.
  void Take(const diagnostic_msgs::DiagnosticArray& message, ros::WallTime now);

  /// What the mapper is doing, and what the pose rests on. One line.
  std::string Activity(ros::WallTime now) const;
  /// What is wrong, node by node; empty if nothing is.
  std::string Problems(ros::WallTime now) const;
  /// Whether the mapper was told to leave the map as it is.
  bool paused() const { return Value("mapper", "paused") == "yes"; }

 private:
  struct Node {
    diagnostic_msgs::DiagnosticStatus status;
    ros::WallTime heard;  ///< zero: never
  };
  bool Silent(const std::string& node, ros::WallTime now) const;
  std::string Value(const std::string& node, const std::string& key) const;

  std::string prefix_;                 ///< of the names in /diagnostics: "" or "robot1/"
  std::map<std::string, Node> nodes_;  ///< by their names without namespace
};

}  // namespace scan_image_slam
