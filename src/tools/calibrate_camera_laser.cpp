// Finds the camera's place on the robot, and its delay, from an ordinary drive.

#include "picture_file.h"
#include "progress_line.h"
#include "run_tool.h"
#include "scan_image_slam/core/calibration/calibrated_camera.h"
#include "scan_image_slam/core/calibration/calibration_picture.h"
#include "scan_image_slam/core/calibration/calibration_recorder.h"
#include "scan_image_slam/core/calibration/calibration_solver.h"
#include "scan_image_slam/core/config/config_file.h"
#include "scan_image_slam/core/pipeline/slam_pipeline.h"
#include "scan_image_slam/ros/bag_input.h"
#include "slam_options.h"

#include <cmath>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <memory>
#include <sstream>

#include <CLI/CLI.hpp>

namespace scan_image_slam {
namespace {

constexpr double kDegrees = Degrees(1.0);  // in a radian

struct Arguments {
  BagArguments input;
  std::string out = "camera_laser.yaml";
  std::string picture;
  bool check = false;
};

/// The stages for a camera whose place is in doubt: it must not touch the poses that judge it, and
/// only edges near the laser's plane belong to what the laser sees.
SlamOptions WithDoubtfulCamera(SlamOptions options) {
  options.bounded_icp.local_map_matcher.filter.edges.max_range = 1e-9;
  options.loop_closer.enabled = false;
  options.fusion.edges.roi_below = 0.25;
  options.fusion.edges.roi_above = 0.5;
  return options;
}

/// A drive and what was recorded of it.
class Drive {
 public:
  Drive(const BagArguments& arguments, const SlamOptions& options)
      : recorder_(CalibrationRecorderOptions{}), pipeline_(options, [this](const auto& result) {
          recorder_.Add(pipeline_.fusion(), result.model, result.match.start_from_base());
        }) {
    BagInput input(arguments.bag, arguments.topics, options);
    for (const std::string& note : input.notes()) std::cerr << note << "\n";
    ProgressLine progress("calibrate_camera_laser");
    input.Play(
        &pipeline_, [](Stage, const std::function<void()>& work) { work(); },
        [&](double share) { progress.Show(share); });
    progress.Finish();
    for (const auto& [reason, count] : input.refused()) {
      std::cerr << "refused " << count << " x " << reason << "\n";
    }
    if (recorder_.data().views.empty()) {
      throw BagError(arguments.bag + ": there is no image beside a scan (" +
                     std::to_string(input.images()) + " images, " +
                     std::to_string(recorder_.data().trajectory.size()) +
                     " scans; choose the topic with --image-topic)");
    }
  }

  const CalibrationRecorder& recorder() const { return recorder_; }
  const ScanImageFusion& fusion() { return pipeline_.fusion(); }

 private:
  CalibrationRecorder recorder_;
  SlamPipeline pipeline_;
};

/// One line for each quantity: the new value of the parameter and how it differs.
struct ReportLine {
  std::string name;
  double value;
  double factor;  ///< from the quantity's unit to the parameter's
  CalibrationIndex index;
  double tolerance;  ///< what --check lets pass, in the parameter's unit
};

std::vector<ReportLine> Lines(const SlamOptions& calibrated) {
  const SensorPose& pose = calibrated.fusion_node.camera;
  return {{"camera/yaw_deg", pose.yaw * kDegrees, kDegrees, kYaw, 0.2},
          {"camera/x", pose.x, 1.0, kForward, 0.01},
          {"camera/y", pose.y, 1.0, kLeft, 0.01},
          {"camera/pitch_deg", pose.pitch * kDegrees, kDegrees, kTiltY, 0.5},
          {"camera/roll_deg", pose.roll * kDegrees, kDegrees, kTiltX, 0.5},
          {"camera_time_offset", calibrated.fusion.camera_time_offset, 1.0, kTime, 0.005}};
}

std::string Report(const CalibrationResult& result, const SlamOptions& calibrated) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(2) << "pairs=" << result.pairs
       << " views=" << result.views << " by_chance=" << result.by_chance
       << " residual_before_px=" << result.rms_before << " residual_after_px=" << result.rms_after
       << "\n"
       << std::setprecision(5);
  for (const ReportLine& line : Lines(calibrated)) {
    const CalibrationQuantity& quantity = result.quantities[line.index];
    text << line.name << " value=" << line.value
         << " correction=" << quantity.correction * line.factor
         << " stddev=" << quantity.stddev * line.factor;
    if (!quantity.refusal.empty()) text << " kept, not observable: " << quantity.refusal;
    text << "\n";
  }
  return text.str();
}

/// The image height of the laser's plane, before and after.
std::string ReportOfPlane(const ScanImageFusion& fusion, const CalibrationResult& result) {
  constexpr double kDistance = 3.0;  // [m]
  const Eigen::Isometry3d assumed = fusion.camera_from_base().inverse();
  const double height = fusion.laser().height;
  std::ostringstream text;
  text << std::fixed << std::setprecision(2) << "laser_plane distance_m=" << kDistance
       << " row_before_px=" << RowOfLaserPlane(*fusion.camera(), assumed, height, kDistance)
       << " row_after_px="
       << RowOfLaserPlane(*fusion.camera(), Corrected(assumed, result.Correction()), height,
                          kDistance)
       << " stddev_px="
       << std::hypot(result.quantities[kTiltX].stddev, result.quantities[kTiltY].stddev) *
              fusion.camera()->intrinsics().k(1, 1)
       << " (the height of the camera is taken as it was)\n";
  return text.str();
}

std::string Verdict(const CalibrationResult& result, const SlamOptions& calibrated) {
  std::string wrong;
  for (const ReportLine& line : Lines(calibrated)) {
    const CalibrationQuantity& quantity = result.quantities[line.index];
    const double correction = std::abs(quantity.correction) * line.factor;
    if (correction < std::max(line.tolerance, 3.0 * quantity.stddev * line.factor)) continue;
    wrong += (wrong.empty() ? "" : ", ") + line.name;
  }
  return wrong.empty() ? "check=fits\n" : "check=off: " + wrong + "\n";
}

SlamOptions Calibrated(SlamOptions options, const Eigen::Isometry3d& base_from_camera,
                       const CalibrationVector& correction) {
  options.fusion_node.camera = CameraPose(Corrected(base_from_camera, correction));
  options.fusion.camera_time_offset += correction[kTime];
  return options;
}

/// What differs from the defaults: a configuration of its own for slam_offline and the launch
/// files.
void WriteYaml(const std::string& path, const std::string& report, SlamOptions calibrated) {
  SlamOptions defaults;
  const std::vector<ParameterSet> usual = defaults.Parameters();
  const std::vector<ParameterSet> sets = calibrated.Parameters();
  std::vector<ParameterSet> changed;
  for (std::size_t i = 0; i < sets.size(); ++i) {
    const ParameterSet different = sets[i].DifferentFrom(usual[i]);
    if (!different.parameters().empty()) changed.push_back(different);
  }
  std::ofstream file(path);
  file << "# Made by calibrate_camera_laser:\n";
  std::istringstream lines(report);
  for (std::string line; std::getline(lines, line);) file << "#   " << line << "\n";
  file << WriteConfig(changed);
  if (!file.flush()) throw std::runtime_error("can't write " + path);
}

void Run(const Arguments& arguments, const SlamOptions& options) {
  Drive drive(arguments.input, WithDoubtfulCamera(options));
  const CalibrationResult result = Calibrate(drive.recorder().data(), CalibrationSolverOptions{});
  if (!arguments.picture.empty()) {
    WritePicture(arguments.picture,
                 DrawCalibration(drive.recorder(), drive.fusion(), result.Correction()));
  }
  if (!result.refusal.empty()) throw BagError(arguments.input.bag + ": " + result.refusal);
  const SlamOptions calibrated =
      Calibrated(options, drive.fusion().camera_from_base().inverse(), result.Correction());
  const std::string report = Report(result, calibrated) + ReportOfPlane(drive.fusion(), result);
  if (!arguments.check) WriteYaml(arguments.out, report, calibrated);
  std::cout << report
            << (arguments.check ? Verdict(result, calibrated) : "written=" + arguments.out + "\n");
}

int Main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app(
      "Finds the camera's pose on the robot and its delay from an ordinary drive: vertical edges "
      "of "
      "the pictures must lie on range discontinuities of the scans.");
  arguments.input.AddTo(&app);
  CLI::Option* out =
      app.add_option("--out", arguments.out, "configuration to write")->capture_default_str();
  app.add_option("--picture", arguments.picture,
                 "draw the scan into an image before and after, e.g. calibration.png");
  app.add_flag("--check", arguments.check, "only report whether the calibration fits")
      ->excludes(out);
  SlamOptions options;
  return RunTool(
      &app, argc, argv, "calibrate_camera_laser", [&] { options = arguments.input.ReadOptions(); },
      [&] { Run(arguments, options); });
}

}  // namespace
}  // namespace scan_image_slam

int main(int argc, char** argv) { return scan_image_slam::Main(argc, argv); }
