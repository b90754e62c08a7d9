// Processor time of each stage for one scan of 1081 beams, on a drive through the simulated
// laboratory. Look at the column CPU: one thread does the work.

#include "scan_image_slam/core/config/slam_parameters.h"
#include "scan_image_slam/core/simulation/camera_lens.h"
#include "scan_image_slam/core/simulation/robot_simulation.h"

#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include <benchmark/benchmark.h>
#include <opencv2/core.hpp>

namespace scan_image_slam {
namespace {

constexpr double kDuration = 6.0;  // [s], of which the robot stands still for the first second

/// What the sensors of one drive gave, in the order of arrival; and how they are mounted.
struct Recording {
  struct Frame {
    LaserScan scan;
    CameraImage image;  ///< the newest before the scan
  };
  std::vector<OdometryReading> odometry;
  std::vector<Frame> frames;
  Eigen::Isometry3d base_from_laser;
  Eigen::Isometry3d base_from_camera;
  CameraIntrinsics intrinsics;
};

CameraIntrinsics ToIntrinsics(const CameraLens& lens) {
  CameraIntrinsics intrinsics;
  intrinsics.width = lens.width;
  intrinsics.height = lens.height;
  intrinsics.k = {lens.fx, 0, lens.cx, 0, lens.fy, lens.cy, 0, 0, 1};
  intrinsics.d.assign(lens.distortion.begin(), lens.distortion.end());
  return intrinsics;
}

CameraImage ToImage(const CameraFrame& frame) {
  CameraImage image;
  image.stamp = frame.stamp;
  image.grey = frame.pixels.clone();
  return image;
}

Recording Record() {
  Scenario scenario = LoadScenario(std::string(SCAN_IMAGE_SLAM_WORLD_DIR) + "/laboratory.yaml");
  scenario.camera.encoding = ImageEncoding::kMono8;
  SimulationOptions options;
  options.duration = kDuration;
  RobotSimulation simulation(std::move(scenario), options);
  Recording recording;
  recording.base_from_laser = simulation.laser_mount().Transform();
  recording.base_from_camera =
      simulation.camera_mount().Transform() * Eigen::Isometry3d(BodyFromOptical());
  recording.intrinsics = ToIntrinsics(simulation.camera_lens());
  CameraImage newest;
  while (const std::optional<SensorEvent> event = simulation.Next()) {
    if (const auto* reading = std::get_if<OdometryReading>(&event->data)) {
      recording.odometry.push_back(*reading);
    } else if (const auto* frame = std::get_if<CameraFrame>(&event->data)) {
      newest = ToImage(*frame);
    } else if (const auto* scan = std::get_if<LaserScan>(&event->data)) {
      if (!newest.grey.empty()) recording.frames.push_back({*scan, newest});
    }
  }
  if (recording.frames.empty() || recording.frames.front().scan.ranges.size() != 1081) {
    throw std::logic_error("the simulated drive has no scans of 1081 beams");
  }
  return recording;
}

const Recording& Drive() {
  static const Recording kRecording = Record();
  return kRecording;
}

template <typename StageType>
void AddOdometry(StageType* stage) {
  for (const OdometryReading& r : Drive().odometry) stage->AddOdometry(r.stamp, r.odom_from_base);
}

ScanImageFusion MakeFusion(bool with_camera) {
  ScanImageFusion fusion{ScanImageFusionOptions{}};
  fusion.SetLaser(LaserMount::From(Drive().base_from_laser));
  if (with_camera) fusion.SetCamera(Drive().intrinsics, Drive().base_from_camera);
  AddOdometry(&fusion);
  return fusion;
}

std::vector<FusedModel> MakeModels(bool with_camera) {
  ScanImageFusion fusion = MakeFusion(with_camera);
  std::vector<FusedModel> models;
  for (const Recording::Frame& frame : Drive().frames) {
    if (with_camera) fusion.AddImage(frame.image);
    models.push_back(fusion.Fuse(frame.scan));
  }
  return models;
}

/// Argument: 1 with a picture of 640x480 for every scan, 0 without.
void Fuse(benchmark::State& state) {
  const bool with_camera = state.range(0) != 0;
  ScanImageFusion fusion = MakeFusion(with_camera);
  const std::vector<Recording::Frame>& frames = Drive().frames;
  std::size_t next = 0;
  std::size_t edges = 0;
  for (auto _ : state) {
    if (with_camera) fusion.AddImage(frames[next].image);
    const FusedModel model = fusion.Fuse(frames[next].scan);
    edges += model.edges.size();
    next = (next + 1) % frames.size();
  }
  state.counters["edges"] =
      benchmark::Counter(static_cast<double>(edges), benchmark::Counter::kAvgIterations);
}
BENCHMARK(Fuse)->ArgName("image")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

void RunMatch(benchmark::State& state, Reference reference) {
  BoundedIcpOptions options;
  options.reference = reference;
  const std::vector<FusedModel> models = MakeModels(state.range(0) != 0);
  BoundedIcp bounded_icp(options);
  std::size_t next = models.size();
  for (auto _ : state) {
    if (next == models.size()) {  // from the start again: a stamp must not come twice
      state.PauseTiming();
      bounded_icp.Reset();
      AddOdometry(&bounded_icp);
      next = 0;
      state.ResumeTiming();
    }
    benchmark::DoNotOptimize(bounded_icp.Match(models[next++]));
  }
}

void MatchLocalMap(benchmark::State& state) { RunMatch(state, Reference::kLocalMap); }
BENCHMARK(MatchLocalMap)->ArgName("edges")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

/// The letter of the paper.
void MatchPreviousFrame(benchmark::State& state) { RunMatch(state, Reference::kPreviousFrame); }
BENCHMARK(MatchPreviousFrame)->ArgName("edges")->Arg(0)->Unit(benchmark::kMillisecond);

/// Argument: 1 if every scan is drawn into the map, 0 with the default thresholds.
void UpdateMap(benchmark::State& state) {
  MapperOptions options;
  if (state.range(0) != 0) {
    options.map_update_distance_thresh = 0.0;
    options.map_update_angle_thresh = 0.0;
    options.map_update_time_thresh = 0.0;
  }
  const std::vector<FusedModel> models = MakeModels(false);
  BoundedIcp bounded_icp{BoundedIcpOptions{}};
  AddOdometry(&bounded_icp);
  std::vector<MatchedMotion> matches;
  matches.reserve(models.size());
  for (const FusedModel& model : models) matches.push_back(bounded_icp.Match(model));
  Mapper mapper(options);
  std::size_t next = models.size();
  for (auto _ : state) {
    if (next == models.size()) {
      state.PauseTiming();
      mapper.Reset();
      next = 0;
      state.ResumeTiming();
    }
    mapper.AddMatch(matches[next]);
    mapper.AddModel(models[next], matches[next]);
    ++next;
  }
}
BENCHMARK(UpdateMap)->ArgName("every_scan")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace scan_image_slam

int main(int argc, char** argv) {
  cv::setNumThreads(1);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
