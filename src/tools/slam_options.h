#pragma once

#include "scan_image_slam/core/config/slam_parameters.h"
#include "scan_image_slam/ros/bag_input.h"

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace scan_image_slam {

/// Options of a configuration: `default`, `paper`, or a yaml file; then `settings`, each
/// NODE/PARAMETER=VALUE, over it. Throws ParameterError for what can't be used.
SlamOptions ReadSlamOptions(const std::string& config, const std::vector<std::string>& settings);

/// Options for the topics of a bag: --scan-topic and so on.
void AddTopicOptions(CLI::App* app, BagTopics* topics);

/// What the programs that run the stages on a bag are told of it.
struct BagArguments {
  std::string bag;
  std::string config = "default";
  std::vector<std::string> settings;
  std::string base_frame;
  BagTopics topics;

  void AddTo(CLI::App* app);
  /// Throws ParameterError as ReadSlamOptions.
  SlamOptions ReadOptions() const;
};

}  // namespace scan_image_slam
