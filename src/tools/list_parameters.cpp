// Prints all parameters of the nodes with their defaults: the source of config/default.yaml.

#include "scan_image_slam/core/config/config_file.h"
#include "scan_image_slam/core/config/slam_parameters.h"

#include <iostream>

#include <CLI/CLI.hpp>

int main(int argc, char** argv) {
  CLI::App app("Prints every parameter of the nodes with its default, unit and range, as yaml.");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 1;
  }
  scan_image_slam::SlamOptions options;
  std::cout << scan_image_slam::WriteConfig(options.Parameters()) << std::flush;
  return std::cout ? 0 : 2;
}
