// Prints all parameters of the nodes with their defaults: the source of config/default.yaml.

#include "scan_image_slam/core/config/config_file.h"
#include "scan_image_slam/core/config/slam_parameters.h"

#include <iostream>

int main() {
  scan_image_slam::SlamOptions options;
  std::cout << scan_image_slam::WriteConfig(options.Parameters());
  return 0;
}
