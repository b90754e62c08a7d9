// Runs the CoreSLAM baseline on a bag, to check it against the figures of the original.

#include "progress_line.h"
#include "run_tool.h"
#include "scan_image_slam/core/baseline/core_slam.h"
#include "scan_image_slam/core/evaluation/trajectory.h"
#include "scan_image_slam/core/pipeline/slam_pipeline.h"
#include "scan_image_slam/core/simulation/random_stream.h"
#include "scan_image_slam/ros/bag_input.h"
#include "thread_time.h"

#include <filesystem>
#include <fstream>
#include <iostream>

#include <CLI/CLI.hpp>

namespace scan_image_slam {
namespace {

struct Arguments {
  std::string bag;
  std::string out;
  BagTopics topics;
  SlamOptions slam;
  CoreSlamOptions core_slam;
  unsigned seed = 1;
};

void Run(const Arguments& arguments) {
  // The first stage of the SLAM reads the sensors and corrects the sweep with the encoders.
  BagInput input(arguments.bag, arguments.topics, arguments.slam);
  std::filesystem::create_directories(arguments.out);

  RandomStream random(arguments.seed, "CoreSLAM");
  CoreSlam core_slam(arguments.core_slam, [&] { return random.Normal(); });
  Trajectory trajectory;
  double milliseconds = 0.0;
  double tries = 0.0;
  SlamPipeline pipeline(arguments.slam, [&](const PipelineResult& result) {
    const double begin = ThreadMilliseconds();
    const Pose2 pose = core_slam.Add(ToCoreSlamScan(result.model, arguments.core_slam.min_range),
                                     result.match.odom_from_base);
    milliseconds += ThreadMilliseconds() - begin;
    tries += core_slam.tries();
    trajectory.push_back({result.model.stamp, pose});
  });
  ProgressLine progress("coreslam_offline");
  input.Play(
      &pipeline, [](Stage, const std::function<void()>& work) { work(); },
      [&](double share) { progress.Show(share); });
  progress.Finish();
  if (trajectory.empty()) throw BagError(arguments.bag + ": no scan could be used");
  WriteTumFile(arguments.out + "/trajectory.tum", trajectory);
  const double scans = static_cast<double>(trajectory.size());
  std::cout << "scans=" << trajectory.size() << " cpu_ms_per_scan=" << milliseconds / scans
            << " tries_per_scan=" << tries / scans << std::endl;
}

int Main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app("Runs the CoreSLAM baseline on a bag; writes OUT/trajectory.tum.");
  app.add_option("--bag", arguments.bag, "bag to read")->required();
  app.add_option("--out", arguments.out, "folder for the result; made if absent")->required();
  app.add_option("--scan-topic", arguments.topics.scan, "LaserScan (default /scan)");
  app.add_option("--odom-topic", arguments.topics.odom, "Odometry (default /odom)");
  app.add_option("--base-frame", arguments.slam.fusion_node.odometry.base_frame,
                 "frame of the robot's base")
      ->capture_default_str();
  app.add_option("--seed", arguments.seed, "of the random search")->capture_default_str();
  app.add_option("--cell-size", arguments.core_slam.cell_size, "[m]")->capture_default_str();
  app.add_option("--rays-per-beam", arguments.core_slam.rays_per_beam, "")->capture_default_str();
  app.add_option("--update-period", arguments.core_slam.update_period,
                 "least time between two scans drawn into the map [s]")
      ->capture_default_str();
  arguments.topics.use_images = false;
  return RunTool(
      &app, argc, argv, "coreslam_offline", [&] { arguments.core_slam.Validate(); },
      [&] { Run(arguments); });
}

}  // namespace
}  // namespace scan_image_slam

int main(int argc, char** argv) { return scan_image_slam::Main(argc, argv); }
