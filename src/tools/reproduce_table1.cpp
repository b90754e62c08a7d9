// The paper's Table 1 and Fig. 6: the proposed method and CoreSLAM on the same simulated runs.

#include "progress_line.h"
#include "run_tool.h"
#include "scan_image_slam/core/config/config_file.h"
#include "scan_image_slam/ros/package_files.h"
#include "slam_options.h"
#include "table1_pictures.h"
#include "table1_report.h"
#include "table1_run.h"

#include <atomic>
#include <exception>
#include <filesystem>
#include <iostream>
#include <mutex>
#include <thread>

#include <CLI/CLI.hpp>

namespace scan_image_slam {
namespace {

/// Different in what makes matching hard; the last one has stretches without a feature.
const std::vector<std::string> kMaps = {
    "laboratory", "ring", "corridor", "hall_pillars", "cluttered_rooms", "corridor_dark"};

struct Arguments {
  std::string out;
  std::vector<std::string> worlds = kMaps;
  std::vector<std::string> sensors = {"ideal", "realistic"};
  int maps = 6;
  int seeds = 5;
  int threads = 2;
  double duration = 45.0;
  bool ablations = false;
  std::vector<std::string> settings;
  CoreSlamOptions core_slam;

  /// Drawn at 40 Hz, the map follows every error of the pose; this does best over all maps.
  Arguments() { core_slam.update_period = 0.25; }
};

Table1Variant MakeVariant(const std::string& name, const std::string& config,
                          std::vector<std::string> settings, const Arguments& arguments) {
  settings.insert(settings.begin(), arguments.settings.begin(), arguments.settings.end());
  return {name, ReadSlamOptions(config, settings), true};
}

/// The first one gives CoreSLAM its scans.
std::vector<Table1Variant> MakeVariants(const Arguments& arguments) {
  const auto make = [&](const std::string& name, const std::string& config,
                        const std::vector<std::string>& settings) {
    return MakeVariant(name, config, settings, arguments);
  };
  std::vector<Table1Variant> variants = {make("default", "default", {}),
                                         make("paper", "paper", {})};
  if (!arguments.ablations) return variants;
  variants.push_back(make("default, no image", "default", {"scan_image_fusion/use_camera=false"}));
  variants.push_back(
      make("default, no refinement", "default", {"bounded_icp/refinement/max_iterations=0"}));
  variants.push_back(make("default, no sweep correction", "default", {}));
  variants.back().correct_sweep = false;
  variants.push_back(
      make("default, frontal 100 deg", "default", {"scan_image_fusion/field_of_view_deg=100.0"}));
  variants.push_back(make("paper, no image", "paper", {"scan_image_fusion/use_camera=false"}));
  variants.push_back(make("paper, no weights", "paper", {"bounded_icp/frame/edge_gain=0.0"}));
  variants.push_back(
      make("paper, whole model", "paper", {"bounded_icp/frame/frontal_field_of_view_deg=100.0"}));
  variants.push_back(make("paper, no sweep correction", "paper", {}));
  variants.back().correct_sweep = false;
  return variants;
}

/// Tells the settings of a reproduction apart from others, so that no old run is taken for a new
/// one.
std::string KeyOf(const Arguments& arguments, const std::vector<Table1Variant>& variants) {
  std::string text = std::to_string(arguments.core_slam.update_period);
  for (const Table1Variant& variant : variants) {
    SlamOptions options = variant.options;
    text += variant.config + WriteConfig(options.Parameters());
  }
  return "duration " + std::to_string(arguments.duration) + ", settings " +
         std::to_string(std::hash<std::string>()(text));
}

std::string FileNameOf(const Table1Job& job) {
  return std::filesystem::path(job.map).stem().string() + "_" + job.sensors + "_" +
         std::to_string(job.seed);
}

/// Does the jobs on several threads; the result does not depend on how many.
class Reproduction {
 public:
  explicit Reproduction(const Arguments& arguments)
      : arguments_(arguments),
        variants_(MakeVariants(arguments)),
        key_(KeyOf(arguments, variants_)),
        progress_("reproduce_table1") {
    for (const std::string& sensors : arguments.sensors) {
      for (int map = 0; map < arguments.maps; ++map) {
        for (int seed = 1; seed <= arguments.seeds; ++seed) {
          jobs_.push_back({arguments.worlds[map], seed, sensors, arguments.duration});
        }
      }
    }
    shares_.resize(jobs_.size(), 0.0);
    rows_.resize(jobs_.size());
    std::filesystem::create_directories(arguments.out + "/runs");
  }

  /// Throws what the first failing job threw.
  std::vector<Table1Row> Run() {
    std::vector<std::thread> threads;
    threads.reserve(static_cast<std::size_t>(arguments_.threads));
    for (int i = 0; i < arguments_.threads; ++i) threads.emplace_back([this] { Work(); });
    for (std::thread& thread : threads) thread.join();
    if (failure_) std::rethrow_exception(failure_);
    progress_.Finish();
    std::vector<Table1Row> all;
    for (const auto& rows : rows_) all.insert(all.end(), rows.begin(), rows.end());
    return all;
  }

 private:
  void Work() {
    for (std::size_t i = next_++; i < jobs_.size(); i = next_++) {
      try {
        rows_[i] = Do(i);
        Show(i, 1.0);
      } catch (...) {
        const std::lock_guard<std::mutex> lock(mutex_);
        if (!failure_) failure_ = std::current_exception();
        next_ = jobs_.size();
      }
    }
  }

  std::vector<Table1Row> Do(std::size_t i) {
    const Table1Job& job = jobs_[i];
    const std::string file = arguments_.out + "/runs/" + FileNameOf(job) + ".csv";
    std::vector<Table1Row> rows = ReadRunFile(file, key_, job);
    if (!rows.empty()) return rows;
    const Scenario scenario = LoadScenario(FindWorld(job.map));
    const Table1Result result = RunTable1(job, scenario, variants_, arguments_.core_slam,
                                          [&](double share) { Show(i, share); });
    if (job.seed == 1) {
      WriteFigure6(arguments_.out + "/figure6_" + FileNameOf(job) + ".png", scenario, result);
    }
    for (const Table1Estimate& estimate : result.estimates) rows.push_back(estimate.row);
    WriteRunFile(file, key_, rows);
    return rows;
  }

  void Show(std::size_t job, double share) {
    const std::lock_guard<std::mutex> lock(mutex_);
    sum_of_shares_ += share - shares_[job];
    shares_[job] = share;
    progress_.Show(sum_of_shares_ / static_cast<double>(jobs_.size()));
  }

  const Arguments& arguments_;
  std::vector<Table1Variant> variants_;
  std::string key_;
  ProgressLine progress_;
  std::vector<Table1Job> jobs_;
  std::vector<std::vector<Table1Row>> rows_;
  std::atomic<std::size_t> next_{0};
  std::mutex mutex_;
  std::vector<double> shares_;
  double sum_of_shares_ = 0.0;
  std::exception_ptr failure_;
};

void Declare(CLI::App& app, Arguments& a) {
  app.add_option("--out", a.out,
                 "folder for table1.csv, table1.md and the pictures; made if absent. Runs that are "
                 "in there already are not repeated")
      ->required();
  app.add_option("--maps", a.maps, "number of maps, the first of the list")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--worlds", a.worlds, "the list: names of shipped worlds, or files")
      ->capture_default_str();
  app.add_option("--seeds", a.seeds, "runs for each map and kind of sensors")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--sensors", a.sensors,
                 "realistic; ideal: only the encoders' radii and wheel base are wrong; perfect: "
                 "nothing is")
      ->check(CLI::IsMember({"perfect", "ideal", "realistic"}))
      ->capture_default_str();
  app.add_option("--threads", a.threads, "runs at the same time; changes no result")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  app.add_option("--duration", a.duration, "of each run [s]")
      ->check(CLI::Range(1.0, 1e4))
      ->capture_default_str();
  app.add_flag("--ablations", a.ablations, "also with parts of the method left out");
  app.add_option("--set", a.settings, "NODE/PARAMETER=VALUE, over both configurations");
  app.add_option("--update-period", a.core_slam.update_period,
                 "CoreSLAM: least time between two scans drawn into the map [s]")
      ->capture_default_str();
}

int Main(int argc, char** argv) {
  CLI::App app("Reproduces the paper's Table 1 and Fig. 6 by simulation.");
  Arguments arguments;
  Declare(app, arguments);
  std::string command = "reproduce_table1";
  for (int i = 1; i < argc; ++i) command += std::string(" ") + argv[i];
  std::unique_ptr<Reproduction> reproduction;
  return RunTool(
      &app, argc, argv, "reproduce_table1",
      [&] {
        arguments.maps = std::min<int>(arguments.maps, static_cast<int>(arguments.worlds.size()));
        cv::setNumThreads(1);  // the runs share the processor
        for (const std::string& world : arguments.worlds) FindWorld(world);
        reproduction = std::make_unique<Reproduction>(arguments);
      },
      [&] { WriteReport(arguments.out, command, reproduction->Run()); });
}

}  // namespace
}  // namespace scan_image_slam

int main(int argc, char** argv) { return scan_image_slam::Main(argc, argv); }
