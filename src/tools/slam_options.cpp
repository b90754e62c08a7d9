#include "slam_options.h"

#include "scan_image_slam/core/config/config_file.h"
#include "scan_image_slam/ros/package_files.h"

namespace scan_image_slam {

SlamOptions ReadSlamOptions(const std::string& config, const std::vector<std::string>& settings) {
  SlamOptions options;
  std::vector<ParameterSet> sets = options.Parameters();
  const bool by_name = config == "default" || config == "paper";
  const std::string path = by_name ? PackageFile("config/" + config + ".yaml") : config;
  ApplyConfig(ReadConfigFile(path), path, &sets);
  for (const std::string& setting : settings) {
    const std::size_t slash = setting.find('/');
    const std::size_t equals = setting.find('=');
    if (slash == std::string::npos || equals == std::string::npos || slash > equals) {
      throw ParameterError("--set " + setting + ": NODE/PARAMETER=VALUE is expected");
    }
    ApplyConfig({{setting.substr(0, slash),
                  {{setting.substr(slash + 1, equals - slash - 1),
                    ParseParameterValue(setting.substr(equals + 1))}}}},
                "--set", &sets);
  }
  return options;
}

void AddTopicOptions(CLI::App* app, BagTopics* topics) {
  app->add_option("--scan-topic", topics->scan, "LaserScan (default /scan)");
  app->add_option("--image-topic", topics->image, "Image or CompressedImage (default /image_raw)");
  app->add_option("--camera-info-topic", topics->camera_info, "CameraInfo (default /camera_info)");
  app->add_option("--odom-topic", topics->odom, "Odometry (default /odom)");
}

void BagArguments::AddTo(CLI::App* app) {
  app->add_option("--bag", bag, "bag to read")->required();
  app->add_option("--config", config, "default, paper, or a yaml file")->capture_default_str();
  app->add_option("--set", settings, "NODE/PARAMETER=VALUE, over the configuration");
  AddTopicOptions(app, &topics);
  app->add_option("--base-frame", base_frame, "frame of the robot's base");
}

SlamOptions BagArguments::ReadOptions() const {
  SlamOptions options = ReadSlamOptions(config, settings);
  if (!base_frame.empty()) options.fusion_node.odometry.base_frame = base_frame;
  return options;
}

}  // namespace scan_image_slam
