#include "run_tool.h"
#include "scan_image_slam/core/evaluation/relations.h"
#include "scan_image_slam/core/evaluation/trajectory.h"

#include <iostream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace scan_image_slam {
namespace {

struct Arguments {
  std::string relations;
  std::string estimate;
  RelationErrorOptions options;
};

void Declare(CLI::App& app, Arguments& arguments) {
  app.add_option("relations", arguments.relations,
                 "true motions, lines: time1 time2 x y z roll pitch yaw")
      ->required();
  app.add_option("estimate", arguments.estimate, "trajectory to judge, TUM format")->required();
  app.add_option("--max-gap", arguments.options.lookup.max_gap,
                 "longest gap between two poses that is interpolated [s]")
      ->capture_default_str();
  app.add_option("--tolerance", arguments.options.lookup.tolerance,
                 "how far away in time a pose may be where none can be interpolated [s]")
      ->capture_default_str();
}

void Evaluate(const Arguments& arguments) {
  const std::vector<Relation> relations = ReadRelationsFile(arguments.relations);
  const Trajectory estimate = ReadTumFile(arguments.estimate);
  const RelationErrors errors = EvaluateRelations(relations, estimate, arguments.options);
  if (errors.used < errors.relations) {
    std::cerr << "evaluate_relations: " << errors.relations - errors.used << " of "
              << errors.relations << " relations are at times without a pose and are left out\n";
  }
  std::cout << ToKeyValues(errors) << std::endl;
}

int Main(int argc, char** argv) {
  CLI::App app{"Errors of a trajectory by relations between poses (Kuemmerle et al. 2009)."};
  Arguments arguments;
  Declare(app, arguments);
  return RunTool(
      &app, argc, argv, "evaluate_relations", [&] { arguments.options.lookup.Validate(); },
      [&] { Evaluate(arguments); });
}

}  // namespace
}  // namespace scan_image_slam

int main(int argc, char** argv) { return scan_image_slam::Main(argc, argv); }
