#include "table1_run.h"

#include "scan_image_slam/core/evaluation/trajectory_errors.h"
#include "scan_image_slam/core/pipeline/slam_pipeline.h"
#include "scan_image_slam/core/simulation/random_stream.h"
#include "scan_image_slam/core/simulation/robot_simulation.h"
#include "scan_image_slam/ros/sensor_conversions.h"
#include "scan_image_slam/ros/simulation_messages.h"
#include "thread_time.h"

#include <memory>

#include <opencv2/imgproc.hpp>

namespace scan_image_slam {
namespace {

/// The trajectory of a method, and the processor time that it took [ms].
struct Recorder {
  Trajectory trajectory;
  double milliseconds = 0.0;

  template <typename Work>
  void Measure(const Work& work) {
    const double begin = ThreadMilliseconds();
    work();
    milliseconds += ThreadMilliseconds() - begin;
  }
};

/// One configuration of the proposed method at work.
class ProposedRun {
 public:
  using OnModel = std::function<void(const PipelineResult&)>;
  ProposedRun(const Table1Variant& variant, const RobotSimulation& simulation, OnModel on_model)
      : variant_(variant),
        on_model_(std::move(on_model)),
        pipeline_(
            variant.options,
            [this](const PipelineResult& result) {
              recorder_.trajectory.push_back({result.pose.stamp, result.pose.map_from_base});
              if (on_model_) on_model_(result);
            },
            [this](Stage, const std::function<void()>& work) { recorder_.Measure(work); }) {
    const MountPose camera = simulation.camera_mount();
    Eigen::Isometry3d base_from_camera = camera.Transform();
    base_from_camera.rotate(BodyFromOptical());
    pipeline_.fusion().SetLaser(LaserMount::From(simulation.laser_mount().Transform()));
    if (!variant.options.fusion_node.use_camera) return;
    pipeline_.fusion().SetCamera(ToCameraIntrinsics(ToMessage(simulation.camera_lens(), 0)),
                                 base_from_camera);
  }

  void Add(const LaserScan& scan, Stamp now) {
    LaserScan copy = scan;
    if (!variant_.correct_sweep) copy.time_increment = 0.0;
    pipeline_.AddScan(copy, now);
  }
  void Add(const OdometryReading& reading, Stamp now) {
    pipeline_.AddOdometry(reading.stamp, reading.odom_from_base, now);
  }
  void Add(const CameraFrame& frame, Stamp now) {
    if (!variant_.options.fusion_node.use_camera) return;
    CameraImage image;
    image.stamp = frame.stamp;
    recorder_.Measure([&] { image.grey = ToGrey(frame); });
    pipeline_.AddImage(image, now);
  }
  void Add(const GroundTruth&, Stamp) {}
  void Finish() { pipeline_.Finish(); }

  const Recorder& recorder() const { return recorder_; }

 private:
  static cv::Mat ToGrey(const CameraFrame& frame) {
    cv::Mat grey;
    switch (frame.encoding) {
      case ImageEncoding::kBgr8:
        cv::cvtColor(frame.pixels, grey, cv::COLOR_BGR2GRAY);
        break;
      case ImageEncoding::kBayerRggb8:
        cv::cvtColor(frame.pixels, grey, cv::COLOR_BayerBG2GRAY);
        break;
      case ImageEncoding::kMono8:
        grey = frame.pixels;
        break;
    }
    return grey;
  }

  const Table1Variant& variant_;
  OnModel on_model_;
  Recorder recorder_;
  SlamPipeline pipeline_;
};

/// Errors with the first poses made to coincide, and the trajectory moved accordingly.
Table1Estimate Judge(const Table1Job& job, const Trajectory& truth, const Recorder& recorder,
                     const std::string& method, const std::string& config) {
  const TrajectoryErrorOptions options;
  const TrajectoryErrors errors = EvaluateTrajectory(truth, recorder.trajectory, options);
  const Pose2 truth_from_map =
      Align(Associate(truth, recorder.trajectory, options.max_gap), options.alignment);
  Table1Estimate estimate;
  estimate.row.job = job;
  estimate.row.method = method;
  estimate.row.config = config;
  estimate.row.error = errors.position.mean;
  estimate.row.yaw = errors.yaw.mean;
  estimate.row.fps = 1e3 * static_cast<double>(recorder.trajectory.size()) / recorder.milliseconds;
  for (const StampedPose& p : recorder.trajectory) {
    estimate.trajectory.push_back({p.stamp, truth_from_map * p.pose});
  }
  return estimate;
}

SimulationOptions OptionsOf(const Table1Job& job) {
  SimulationOptions options;
  options.seed = static_cast<std::uint64_t>(job.seed);
  options.duration = job.duration;
  options.ideal = job.sensors != "realistic";
  options.ideal_encoders = job.sensors == "perfect";
  return options;
}

}  // namespace

Table1Result RunTable1(const Table1Job& job, Scenario scenario,
                       const std::vector<Table1Variant>& variants,
                       const CoreSlamOptions& core_slam_options,
                       const std::function<void(double)>& progress) {
  RobotSimulation simulation(std::move(scenario), OptionsOf(job));
  RandomStream random(static_cast<std::uint64_t>(job.seed), "CoreSLAM");
  CoreSlam core_slam(core_slam_options, [&] { return random.Normal(); });
  Recorder core_slam_recorder;
  const auto run_core_slam = [&](const PipelineResult& result) {
    core_slam_recorder.Measure([&] {
      const CoreSlamScan scan = ToCoreSlamScan(result.model, core_slam_options.min_range);
      core_slam_recorder.trajectory.push_back(
          {scan.stamp, core_slam.Add(scan, result.match.odom_from_base)});
    });
  };
  std::vector<std::unique_ptr<ProposedRun>> runs;
  runs.reserve(variants.size());
  for (const Table1Variant& variant : variants) {
    runs.push_back(std::make_unique<ProposedRun>(
        variant, simulation, runs.empty() ? ProposedRun::OnModel(run_core_slam) : nullptr));
  }
  Table1Result result;
  while (const std::optional<SensorEvent> event = simulation.Next()) {
    if (const auto* truth = std::get_if<GroundTruth>(&event->data)) {
      result.truth.push_back({truth->stamp, truth->world_from_base});
    }
    for (const auto& run : runs) {
      std::visit([&](const auto& data) { run->Add(data, event->arrival); }, event->data);
    }
    progress(simulation.progress());
  }
  for (const auto& run : runs) run->Finish();
  result.estimates.push_back(Judge(job, result.truth, core_slam_recorder, "coreslam", "original"));
  for (std::size_t i = 0; i < runs.size(); ++i) {
    result.estimates.push_back(
        Judge(job, result.truth, runs[i]->recorder(), "proposed", variants[i].config));
  }
  return result;
}

}  // namespace scan_image_slam
