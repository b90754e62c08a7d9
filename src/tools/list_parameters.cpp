// Prints all parameters of the nodes with their defaults: the source of config/default.yaml and of
// docs/parameters.md.

#include "scan_image_slam/core/config/config_file.h"
#include "scan_image_slam/core/config/parameter_reference.h"
#include "scan_image_slam/core/config/slam_parameters.h"

#include <iostream>

#include <CLI/CLI.hpp>

int main(int argc, char** argv) {
  CLI::App app("Prints every parameter of the nodes with its default, unit and range, as yaml.");
  bool markdown = false;
  app.add_flag("--markdown", markdown, "as a page of Markdown instead");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 1;
  }
  scan_image_slam::SlamOptions options;
  const auto sets = options.Parameters();
  std::cout << (markdown ? scan_image_slam::WriteReference(sets)
                         : scan_image_slam::WriteConfig(sets))
            << std::flush;
  return std::cout ? 0 : 2;
}
