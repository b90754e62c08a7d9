// Runs the three stages on a bag, in process and as fast as the machine allows.

#include "fusion_pictures.h"
#include "picture_file.h"
#include "progress_line.h"
#include "run_tool.h"
#include "scan_image_slam/core/evaluation/statistics.h"
#include "scan_image_slam/core/evaluation/trajectory.h"
#include "scan_image_slam/core/mapping/map_file.h"
#include "scan_image_slam/core/mapping/map_picture.h"
#include "scan_image_slam/core/mapping/state_file.h"
#include "scan_image_slam/core/pipeline/slam_pipeline.h"
#include "scan_image_slam/ros/bag_input.h"
#include "slam_options.h"
#include "thread_time.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <iostream>
#include <limits>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <sys/resource.h>

namespace scan_image_slam {
namespace {

struct Arguments {
  BagArguments input;
  std::string out;
  bool no_images = false;
  FusionPictures::Options pictures;
  int threads = 1;
  std::string state;  ///< to begin with; empty: none
  bool localization = false;
  std::string save_state;  ///< to be written; empty: none
};

/// Milliseconds that the stages took for each scan: wall time, and processor time of this thread.
class StageTimes {
 public:
  void Run(Stage stage, const std::function<void()>& work) {
    const auto wall = std::chrono::steady_clock::now();
    const double cpu = ThreadMilliseconds();
    work();
    current_[static_cast<int>(stage)] +=
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - wall).count();
    cpu_ms_ += ThreadMilliseconds() - cpu;
  }

  void FinishScan() {
    for (std::size_t i = 0; i < current_.size(); ++i) {
      times_[i].push_back(current_[i]);
      current_[i] = 0.0;
    }
  }

  double cpu_ms() const { return cpu_ms_; }

  nlohmann::json Report() const {
    nlohmann::json report;
    const std::array<const char*, 4> names = {"fusion", "match", "map", "loop"};
    for (std::size_t i = 0; i < names.size(); ++i) report[names[i]] = Summary(times_[i]);
    return report;
  }

 private:
  static nlohmann::json Summary(std::vector<double> times) {
    if (times.empty()) times.push_back(0.0);
    return {{"min_ms", *std::min_element(times.begin(), times.end())},
            {"median_ms", Percentile(times, 50.0)},
            {"p99_ms", Percentile(times, 99.0)},
            {"max_ms", Percentile(times, 100.0)}};
  }

  std::array<double, 4> current_{};
  std::array<std::vector<double>, 4> times_;
  double cpu_ms_ = 0.0;
};

/// What is kept of a run.
struct Run {
  Trajectory online;
  Trajectory encoder;
  std::map<std::string, double> seconds_in_mode{{"full", 0.0},
                                                {"no_camera", 0.0},
                                                {"no_encoders", 0.0},
                                                {"laser_only", 0.0},
                                                {"coasting", 0.0}};
  int window_edge_hits = 0;
  int scans = 0;
  Stamp first_stamp = 0;
  Stamp last_stamp = 0;
  double lost_s = 0.0;  ///< without a pose in the map that was loaded

  void Add(const PipelineResult& result) {
    if (scans++ == 0) {
      first_stamp = result.pose.stamp;
    } else {
      const double seconds = Seconds(result.pose.stamp - last_stamp);
      const MatchMode mode = seconds > kLaserGap ? MatchMode::kCoasting : result.match.mode;
      seconds_in_mode[ModeName(mode)] += seconds;
      if (result.pose.lost) lost_s += seconds;
    }
    last_stamp = result.pose.stamp;
    if (!result.pose.lost) online.push_back({result.pose.stamp, result.pose.map_from_base});
    if (result.match.odom_from_base) {
      encoder.push_back({result.pose.stamp, *result.match.odom_from_base});
    }
    if (result.match.status == MatchStatus::kOnWindowEdge) ++window_edge_hits;
  }
};

double PeakMemoryMegabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

/// The encoders' path as it would lie in the map: beginning at the same pose as the estimate.
std::vector<Pose2> EncoderPathInMap(const Run& run) {
  std::vector<Pose2> path;
  const auto from = std::find_if(run.encoder.begin(), run.encoder.end(), [&](const auto& p) {
    return p.stamp >= run.online.front().stamp;
  });
  if (from == run.encoder.end()) return path;
  const Pose2 map_from_odom = run.online.front().pose * from->pose.Inverse();
  for (const StampedPose& p : run.encoder) path.push_back(map_from_odom * p.pose);
  return path;
}

void MakeFolder(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  const std::string probe = path + "/.slam_offline";
  if (error || !std::ofstream(probe)) {
    throw std::runtime_error("can't write into " + path + ": " +
                             (error ? error.message() : std::strerror(errno)));
  }
  std::filesystem::remove(probe);
}

void WriteResults(const Arguments& arguments, const Run& run, const Trajectory& final_trajectory,
                  const OccupancyGrid& grid) {
  WriteTumFile(arguments.out + "/trajectory.tum", final_trajectory);
  WriteTumFile(arguments.out + "/online.tum", run.online);
  WriteTumFile(arguments.out + "/encoder.tum", run.encoder);
  const MapImage map = ToMapImage(grid);
  WriteMap(map, arguments.out + "/map");
  DrawnPath estimate{"estimate", kEstimateColour, {}};
  for (const StampedPose& p : final_trajectory) estimate.poses.push_back(p.pose);
  const DrawnPath encoders{"encoders", kEncoderColour, EncoderPathInMap(run)};
  WritePicture(arguments.out + "/map.png", DrawMap(map, {encoders, estimate}));
}

void RunOffline(const Arguments& arguments, const SlamOptions& options) {
  BagInput input(arguments.input.bag, arguments.input.topics, options);
  for (const std::string& note : input.notes()) std::cerr << note << "\n";
  MakeFolder(arguments.out);

  Run run;
  FusionPictures pictures(arguments.out, arguments.pictures);
  StageTimes times;
  const auto run_stage = [&](Stage stage, const std::function<void()>& work) {
    times.Run(stage, work);
  };
  SlamPipeline pipeline(
      options,
      [&](const PipelineResult& result) {
        run.Add(result);
        pictures.Add(pipeline.fusion(), result);
        times.FinishScan();
      },
      run_stage);
  if (!arguments.state.empty()) {
    pipeline.Load(ReadState(arguments.state),
                  arguments.localization ? MapUse::kLocalize : MapUse::kContinue);
  }
  const auto begin = std::chrono::steady_clock::now();
  ProgressLine progress("slam_offline");
  input.Play(&pipeline, run_stage, [&](double share) { progress.Show(share); });
  progress.Finish();
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  for (const auto& [reason, count] : input.refused()) {
    std::cerr << "refused " << count << " x " << reason << "\n";
  }
  if (run.scans == 0) throw BagError(arguments.input.bag + ": no scan could be used");
  if (run.online.empty()) {
    throw BagError(arguments.input.bag + ": the robot was not found in the map of " +
                   arguments.state);
  }

  pipeline.mapper().Redraw(std::numeric_limits<int>::max());
  Trajectory trajectory;
  for (const MapPose& pose : pipeline.mapper().Trajectory()) {
    trajectory.push_back({pose.stamp, pose.map_from_base});
  }
  WriteResults(arguments, run, trajectory, pipeline.mapper().grid());
  if (!arguments.save_state.empty()) WriteState(pipeline.Save(), arguments.save_state);
  const double recorded = Seconds(run.last_stamp - run.first_stamp);
  const LearnedCalibration learned = pipeline.bounded_icp().learned();
  nlohmann::json report = {
      {"scans", run.scans},
      {"lost_s", run.lost_s},
      {"images", input.images()},
      {"real_time_factor", recorded / std::max(1e-9, seconds)},
      {"cpu_ms_per_scan", times.cpu_ms() / run.scans},
      {"peak_memory_mb", PeakMemoryMegabytes()},
      {"stages", times.Report()},
      {"window_edge_hits", run.window_edge_hits},
      {"encoder_scale", learned.encoder_scale},
      {"camera_yaw_deg", Degrees(learned.camera_yaw)},
      {"camera_yaw_stddev_deg", Degrees(learned.camera_yaw_stddev)},
      {"loop_closures", pipeline.loop_closer().closures()},
      {"dropped", pipeline.dropped()},
  };
  for (const auto& [name, duration] : run.seconds_in_mode) report["modes"][name + "_s"] = duration;
  std::ofstream file(arguments.out + "/report.json");
  file << report.dump(2) << "\n";
  if (!file.flush()) throw std::runtime_error("can't write " + arguments.out + "/report.json");
}

int Main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app("Runs scan_image_slam on a bag, without a ROS master.");
  arguments.input.AddTo(&app);
  app.add_option("--out", arguments.out, "folder for the results; made if absent")->required();
  app.add_flag("--no-images", arguments.no_images, "laser and encoders only");
  app.add_option("--fusion-images", arguments.pictures.every,
                 "write what the fusion sees, fusion_000001.png, for every so many images; 0: none")
      ->capture_default_str()
      ->check(CLI::Range(0, std::numeric_limits<int>::max()));
  app.add_option("--video", arguments.pictures.video,
                 "write what the fusion sees of all images as a film, FILE.avi");
  app.add_option("--threads", arguments.threads, "threads of the image processing")
      ->capture_default_str()
      ->check(CLI::Range(1, 64));
  CLI::Option* state =
      app.add_option("--state", arguments.state, "map to begin with, as --save-state wrote it");
  app.add_flag("--localization", arguments.localization, "leave the map of --state as it is")
      ->needs(state);
  app.add_option("--save-state", arguments.save_state, "write the map, to go on with it later");
  SlamOptions options;
  return RunTool(
      &app, argc, argv, "slam_offline",
      [&] {
        cv::setNumThreads(arguments.threads);
        options = arguments.input.ReadOptions();
        options.mapper.max_trajectory_poses = std::numeric_limits<int>::max();
        arguments.input.topics.use_images = !arguments.no_images && options.fusion_node.use_camera;
      },
      [&] { RunOffline(arguments, options); });
}

}  // namespace
}  // namespace scan_image_slam

int main(int argc, char** argv) { return scan_image_slam::Main(argc, argv); }
