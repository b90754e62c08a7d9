#pragma once

#include "scan_image_slam/core/simulation/camera_simulator.h"
#include "scan_image_slam/core/simulation/encoder_simulator.h"
#include "scan_image_slam/core/simulation/laser_simulator.h"
#include "scan_image_slam/core/simulation/path_follower.h"
#include "scan_image_slam/core/simulation/scenario.h"

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace scan_image_slam {

struct SimulationOptions {
  std::uint64_t seed = 1;
  Stamp start = 1700000000LL * 1000000000LL;  ///< stamp of the beginning [ns]
  bool images = true;          ///< without, the other sensors measure exactly the same
  bool ideal = false;          ///< sensors without noise, bias, rounding, losses and blur
  bool ideal_encoders = true;  ///< if `ideal`: encoders without errors of radius and wheel base
  std::string path;            ///< name of the path; empty: the first
  int rounds = 1;              ///< so often the path is driven, from its end on to its way points
  bool follow_path = true;     ///< else the robot waits for Drive()
  /// Length of the run [s]; without, it ends with the path (never, if no path is followed).
  std::optional<double> duration;
};

struct CameraFrame {
  Stamp stamp = 0;  ///< [ns]
  cv::Mat pixels;   ///< CV_8UC1 or CV_8UC3; not to be written to
  ImageEncoding encoding = ImageEncoding::kMono8;
};

/// For the judge only, never for a SLAM: where the base was when the first beam of a scan was
/// fired.
struct GroundTruth {
  Stamp stamp = 0;  ///< that of the scan [ns]
  Pose2 world_from_base;
};

struct SensorEvent {
  Stamp arrival = 0;  ///< when the computer gets it [ns]
  std::variant<LaserScan, CameraFrame, OdometryReading, GroundTruth> data;
};

/// A robot that drives through a world and measures. The same scenario and options give the same
/// events, byte by byte; there is no clock in here.
class RobotSimulation {
 public:
  /// Throws std::invalid_argument for options out of range and an unknown path.
  RobotSimulation(Scenario scenario, const SimulationOptions& options);
  RobotSimulation(const RobotSimulation&) = delete;
  RobotSimulation& operator=(const RobotSimulation&) = delete;

  /// The next event in the order of arrival; nothing when the run is over.
  std::optional<SensorEvent> Next();

  /// All events that arrive up to `time`, for runs in step with a clock.
  std::vector<SensorEvent> Advance(Stamp time);

  /// From now on the robot does what it is told instead of following the path. It stops before it
  /// runs into something.
  void Drive(const Velocity& command);

  bool finished() const;
  /// Part of the run that is over, 0 to 1.
  double progress() const;
  Stamp now() const { return drive_.state().time; }
  /// True motion now; for the judge only.
  const TrueState& truth() const { return drive_.state(); }

  /// What the robot's description and calibration say.
  MountPose laser_mount() const;   ///< base_from_laser; rolled by pi if it hangs upside down
  MountPose camera_mount() const;  ///< base_from_camera: x ahead, y left, z up
  CameraLens camera_lens() const;
  const Scenario& scenario() const { return scenario_; }

 private:
  void Step();
  Velocity Command() const;
  void MeasureScan();
  void TakeImage();
  void ReadEncoders();
  double Elapsed(Stamp time) const { return Seconds(time - options_.start); }

  Scenario scenario_;
  SimulationOptions options_;
  FaultSchedule faults_;
  PathFollower follower_;
  DriveSimulator drive_;
  EncoderSimulator encoders_;
  LaserSimulator laser_;
  std::unique_ptr<CameraSimulator> camera_;
  MotionHistory history_;
  std::optional<Velocity> told_;
  std::optional<Stamp> path_end_;
  cv::Mat last_pixels_;
  std::multimap<Stamp, SensorEvent> pending_;  // by arrival, then in the order of measuring
};

}  // namespace scan_image_slam
