// Judges a map by the plan of the simulated world that it was made in.

#include "picture_file.h"
#include "run_tool.h"
#include "scan_image_slam/core/evaluation/map_quality.h"
#include "scan_image_slam/core/evaluation/map_quality_picture.h"
#include "scan_image_slam/core/evaluation/trajectory.h"
#include "scan_image_slam/core/mapping/map_reader.h"
#include "scan_image_slam/core/simulation/scenario.h"
#include "scan_image_slam/core/simulation/true_plan.h"
#include "scan_image_slam/ros/package_files.h"

#include <iostream>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace scan_image_slam {
namespace {

struct Arguments {
  std::string world;
  std::string truth;
  std::string map;
  std::string plot;
  std::vector<double> pose;
  std::optional<Pose2> world_from_map;  ///< what `pose` says
  MapQualityOptions options;
};

void Declare(CLI::App& app, Arguments& a) {
  app.add_option("world", a.world, "world file, or name of a shipped one, e.g. corridor")
      ->required();
  app.add_option("truth", a.truth, "true trajectory of the run, as simulate writes it (.gt.tum)")
      ->required();
  app.add_option("map", a.map, "map to judge: the yaml of map_server")->required();
  app.add_option(
         "--pose", a.pose,
         "where the frame of the map lies in the world [m] [m] [deg]; default: at the first "
         "pose of the truth")
      ->type_name("X Y YAW")
      ->expected(3);
  app.add_option("--tolerance", a.options.tolerance,
                 "how far a cell's centre may be from what it shows [m]")
      ->capture_default_str();
  app.add_option("--plot", a.plot, "picture to write, e.g. agreement.png");
}

void ParsePose(Arguments& a) {
  if (a.pose.empty()) return;
  a.world_from_map = {a.pose[0], a.pose[1], a.pose[2] * M_PI / 180.0};
  if (!IsFinite(*a.world_from_map)) throw std::invalid_argument("--pose must be finite");
}

void Evaluate(const Arguments& arguments) {
  const Scenario scenario = LoadScenario(FindWorld(arguments.world));
  std::vector<Pose2> world_from_base;
  for (const StampedPose& p : ReadTumFile(arguments.truth)) world_from_base.push_back(p.pose);
  const MapImage map = ReadMap(arguments.map);
  const Pose2 world_from_map = arguments.world_from_map.value_or(world_from_base.front());
  const TruePlan plan = SeenPlan(scenario.world, scenario.laser, world_from_base, map.resolution);
  if (plan.walls.empty()) {
    throw std::runtime_error("nothing of the world " + arguments.world +
                             " is seen from the poses of " + arguments.truth +
                             ": do the two belong together?");
  }
  const MapQuality quality = EvaluateMap(map, plan, world_from_map, arguments.options);
  if (!arguments.plot.empty()) {
    WritePicture(arguments.plot, DrawMapQuality(map, plan, world_from_map, quality));
  }
  std::cout << ToKeyValues(quality) << std::endl;
}

int Main(int argc, char** argv) {
  CLI::App app("Agreement of a map with the simulated world: precision, recall, wall thickness.");
  Arguments arguments;
  Declare(app, arguments);
  return RunTool(
      &app, argc, argv, "evaluate_map",
      [&] {
        arguments.options.Validate();
        ParsePose(arguments);
      },
      [&] { Evaluate(arguments); });
}

}  // namespace
}  // namespace scan_image_slam

int main(int argc, char** argv) { return scan_image_slam::Main(argc, argv); }
