// Says what a bag holds, what is missing or odd in it, and how to map with it.

#include "bag_commands.h"
#include "bag_contents.h"
#include "bag_plan.h"
#include "bag_report.h"
#include "progress_line.h"
#include "run_tool.h"
#include "slam_options.h"

#include <iostream>

#include <CLI/CLI.hpp>

namespace scan_image_slam {
namespace {

struct Arguments {
  std::string bag;
  BagTopics topics;
  std::string slam_offline;  ///< how it is called
};

/// As the program was called: by its name alone, or by rosrun and the like.
std::string CallOfSlamOffline(const std::string& own_name) {
  const bool by_name = own_name.find('/') == std::string::npos;
  return by_name ? "slam_offline" : "rosrun scan_image_slam slam_offline";
}

void Check(const Arguments& arguments) {
  ProgressLine progress("check_bag");
  const BagContents contents =
      ReadBagContents(arguments.bag, [&](double share) { progress.Show(share); });
  progress.Finish();
  const BagPlan plan = MakeBagPlan(contents, arguments.topics);
  const std::string findings = FindingsText(CheckContents(contents, plan));
  const std::string report = DescribeContents(contents, plan) + "missing or odd:\n" +
                             (findings.empty() ? "  nothing\n" : findings);
  if (!plan.usable()) throw BagError(arguments.bag + " can't be mapped with:\n" + report);
  // What is told to work is tried.
  const BagInput tried(arguments.bag, PlannedTopics(plan), PlannedOptions(plan));
  std::cout << report << "to map with it:\n";
  for (const std::string& line : CommandLines(contents, plan, arguments.slam_offline)) {
    std::cout << "  " << line << "\n";
  }
}

int Main(int argc, char** argv) {
  Arguments arguments;
  arguments.slam_offline = CallOfSlamOffline(argv[0]);
  CLI::App app("Says what a bag holds, what is missing or odd in it, and how to map with it.");
  app.add_option("bag", arguments.bag, "bag to read")->required();
  AddTopicOptions(&app, &arguments.topics);
  return RunTool(
      &app, argc, argv, "check_bag", [] {}, [&] { Check(arguments); });
}

}  // namespace
}  // namespace scan_image_slam

int main(int argc, char** argv) { return scan_image_slam::Main(argc, argv); }
