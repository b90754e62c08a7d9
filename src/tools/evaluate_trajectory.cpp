#include "run_tool.h"
#include "scan_image_slam/core/evaluation/trajectory.h"
#include "scan_image_slam/core/evaluation/trajectory_errors.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace scan_image_slam {
namespace {

constexpr char kPlotScript[] = "plot_trajectory.py";
// Another python in the PATH would not see the distribution's matplotlib.
constexpr char kPython[] = "/usr/bin/python3";

struct Arguments {
  std::string reference;
  std::string estimate;
  std::string alignment = "first";
  TrajectoryErrorOptions options;
  std::string plot;
};

void Declare(CLI::App& app, Arguments& arguments) {
  app.add_option("reference", arguments.reference, "true trajectory, TUM format")->required();
  app.add_option("estimate", arguments.estimate, "trajectory to judge, TUM format")->required();
  app.add_option("--align", arguments.alignment,
                 "make the first poses coincide (first), fit as well as possible (best), or take "
                 "both as they are (none)")
      ->check(CLI::IsMember({"first", "best", "none"}))
      ->capture_default_str();
  app.add_option("--max-gap", arguments.options.max_gap,
                 "longest gap between two reference poses that is interpolated [s]")
      ->capture_default_str();
  app.add_option("--plot", arguments.plot, "picture to write, e.g. errors.png");
}

Alignment ParseAlignment(const std::string& text) {
  if (text == "best") return Alignment::kBest;
  if (text == "none") return Alignment::kNone;
  return Alignment::kFirst;
}

/// The script beside the executable, in the devel space as in the install space.
std::string FindPlotScript() {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const fs::path folder = fs::read_symlink("/proc/self/exe", ignored).parent_path();
  if (fs::exists(folder / kPlotScript, ignored)) return (folder / kPlotScript).string();
  throw std::runtime_error(std::string("cannot plot: ") + kPlotScript + " is not in " +
                           folder.string());
}

/// Runs a program, its output on stderr because stdout holds the result; returns its exit status.
int Run(std::vector<std::string> command) {
  std::vector<char*> arguments;
  arguments.reserve(command.size() + 1);
  for (std::string& word : command) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, STDERR_FILENO, STDOUT_FILENO);
  pid_t child = 0;
  const int error =
      posix_spawn(&child, arguments.front(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) {
    throw std::runtime_error("cannot run " + command.front() + ": " + std::strerror(error));
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) throw std::runtime_error("lost " + command.front());
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : EXIT_FAILURE;
}

void Plot(const Arguments& arguments) {
  // -I: whatever PYTHONPATH says, the distribution's packages.
  const int status =
      Run({kPython, "-I", FindPlotScript(), "--reference=" + arguments.reference,
           "--estimate=" + arguments.estimate, "--align=" + arguments.alignment,
           "--max-gap=" + std::to_string(arguments.options.max_gap), "--out=" + arguments.plot});
  if (status != 0) throw std::runtime_error("cannot plot: " + arguments.plot + " was not written");
}

void Evaluate(const Arguments& arguments) {
  const Trajectory reference = ReadTumFile(arguments.reference);
  const Trajectory estimate = ReadTumFile(arguments.estimate);
  const TrajectoryErrors errors = EvaluateTrajectory(reference, estimate, arguments.options);
  if (errors.matched < errors.poses) {
    std::cerr << "evaluate_trajectory: " << errors.poses - errors.matched << " of " << errors.poses
              << " poses have no reference and are left out\n";
  }
  std::cout << ToKeyValues(errors) << std::endl;
}

int Main(int argc, char** argv) {
  CLI::App app{"Absolute and relative errors of a trajectory (ATE, RPE; Sturm et al. 2012)."};
  Arguments arguments;
  Declare(app, arguments);
  return RunTool(
      &app, argc, argv, "evaluate_trajectory",
      [&] {
        arguments.options.alignment = ParseAlignment(arguments.alignment);
        arguments.options.Validate();
      },
      [&] {
        Evaluate(arguments);
        if (!arguments.plot.empty()) Plot(arguments);
      });
}

}  // namespace
}  // namespace scan_image_slam

int main(int argc, char** argv) { return scan_image_slam::Main(argc, argv); }
