#include "scan_image_slam/core/simulation/robot_simulation.h"

#include <algorithm>
#include <cmath>

namespace scan_image_slam {
namespace {

constexpr Stamp kTick = 1000000;          // [ns]
constexpr double kRobotRadius = 0.25;     // [m]
constexpr double kRobotHeight = 1.0;      // [m]
constexpr double kBumperDistance = 0.05;  // looked ahead when driven by hand [m]
constexpr double kCoveredLevel = 12.0;    // grey of a covered lens

Scenario Prepare(Scenario scenario, const SimulationOptions& options) {
  if (options.ideal) {
    scenario.laser = Ideal(scenario.laser);
    scenario.camera = Ideal(scenario.camera);
    scenario.base = Ideal(scenario.base, options.ideal_encoders);
  }
  const RobotPath& path = FindPath(scenario, options.path);
  scenario.base.max_speed = std::max(scenario.base.max_speed, path.speed);
  scenario.base.max_turn_rate = std::max(scenario.base.max_turn_rate, path.turn_rate);
  return scenario;
}

double HistoryLength(const Scenario& scenario) {
  return scenario.laser.Period() + scenario.camera.Period() + 0.5;
}

TrueState StartState(const Scenario& scenario, const SimulationOptions& options) {
  return {options.start, FindPath(scenario, options.path).start, 0.0, 0.0};
}

RobotPath Repeated(RobotPath path, int rounds) {
  const std::vector<Eigen::Vector2d> round = path.way_points;
  for (int i = 1; i < rounds; ++i) {
    path.way_points.insert(path.way_points.end(), round.begin(), round.end());
  }
  return path;
}

}  // namespace

RobotSimulation::RobotSimulation(Scenario scenario, const SimulationOptions& options)
    : scenario_(Prepare(std::move(scenario), options)),
      options_(options),
      faults_(scenario_.faults),
      follower_(Repeated(FindPath(scenario_, options.path), options.rounds)),
      drive_(scenario_.base, StartState(scenario_, options), options.seed),
      encoders_(scenario_.base, options.seed, options.start),
      laser_(scenario_.world, scenario_.laser, options.seed, options.start),
      history_(HistoryLength(scenario_)) {
  if (options.images) {
    camera_ = std::make_unique<CameraSimulator>(scenario_.world, scenario_.camera, options.seed,
                                                options.start);
  }
  history_.Add(drive_.state());
}

bool RobotSimulation::finished() const {
  if (options_.duration) return Elapsed(now()) >= *options_.duration;
  return path_end_.has_value() && now() >= *path_end_;
}

double RobotSimulation::progress() const {
  if (options_.duration) return std::min(Elapsed(now()) / *options_.duration, 1.0);
  return follower_.share();
}

std::optional<SensorEvent> RobotSimulation::Next() {
  // What is measured from now on arrives later than now.
  while (!finished() && (pending_.empty() || pending_.begin()->first > now())) Step();
  if (pending_.empty()) return std::nullopt;
  SensorEvent event = std::move(pending_.begin()->second);
  pending_.erase(pending_.begin());
  return event;
}

std::vector<SensorEvent> RobotSimulation::Advance(Stamp time) {
  while (!finished() && now() < time) Step();
  std::vector<SensorEvent> events;
  while (!pending_.empty() && pending_.begin()->first <= time) {
    events.push_back(std::move(pending_.begin()->second));
    pending_.erase(pending_.begin());
  }
  return events;
}

void RobotSimulation::Drive(const Velocity& command) { told_ = command; }

Velocity RobotSimulation::Command() const {
  if (!told_) return {};
  const Pose2& pose = drive_.state().world_from_base;
  const double time = Elapsed(now());
  const double speed = drive_.state().speed;
  const double braking = speed * speed / (2.0 * scenario_.base.acceleration);
  const double step = std::copysign(kBumperDistance + braking, told_->speed);
  const double here = Clearance(scenario_.world, pose.translation(), kRobotHeight, time);
  const double there =
      Clearance(scenario_.world, pose * Eigen::Vector2d(step, 0.0), kRobotHeight, time);
  const bool blocked = there < kRobotRadius && there < here;
  return {blocked ? 0.0 : told_->speed, told_->turn_rate};
}

void RobotSimulation::Step() {
  const Stamp before = now();
  const Stamp time =
      std::min(before - before % kTick + kTick, std::max(encoders_.NextReading(), before + 1));
  const RobotPath& path = FindPath(scenario_, options_.path);
  Velocity command = Command();
  if (!told_ && options_.follow_path && Elapsed(before) >= path.start_pause) {
    command = follower_.Command(drive_.state());
    if (follower_.done() && !path_end_) path_end_ = before + FromSeconds(path.end_pause);
  }
  drive_.StepTo(time, command);
  history_.Add(drive_.state());
  encoders_.Follow(drive_.state());
  encoders_.AddFalseTurn(faults_.FalseTurn(Elapsed(before), Elapsed(time)));
  if (faults_.Begins(Fault::Kind::kEncodersReset, Elapsed(before), Elapsed(time))) {
    encoders_.Reset();
  }
  if (encoders_.NextReading() <= time) ReadEncoders();
  while (laser_.NextComplete() <= time) MeasureScan();
  while (camera_ && camera_->NextComplete() <= time) TakeImage();
}

void RobotSimulation::ReadEncoders() {
  const OdometryReading reading = encoders_.Read();
  if (faults_.Active(Fault::Kind::kEncodersOff, Elapsed(reading.stamp))) return;
  pending_.insert({reading.arrival, {reading.arrival, reading}});
}

void RobotSimulation::MeasureScan() {
  SimulatedScan scan = laser_.Measure(history_);
  if (faults_.Active(Fault::Kind::kLaserOff, Elapsed(scan.first_beam))) return;
  const GroundTruth truth{scan.scan.stamp, history_.At(scan.first_beam).world_from_base};
  pending_.insert({scan.arrival, {scan.arrival, std::move(scan.scan)}});
  pending_.insert({scan.arrival, {scan.arrival, truth}});
}

void RobotSimulation::TakeImage() {
  const double time = Elapsed(camera_->NextComplete());
  const auto active = [&](Fault::Kind kind) { return faults_.Active(kind, time); };
  SimulatedImage image;
  if (active(Fault::Kind::kCameraOff)) {
    camera_->Skip();
    return;
  }
  if (active(Fault::Kind::kCameraFrozen) && !last_pixels_.empty()) {
    image = camera_->Skip();
    image.pixels = last_pixels_;
  } else if (active(Fault::Kind::kCameraBlack)) {
    image = camera_->TakeUniform(0.0);
  } else if (active(Fault::Kind::kCameraOverexposed)) {
    image = camera_->TakeUniform(255.0);
  } else if (active(Fault::Kind::kCameraCovered)) {
    image = camera_->TakeUniform(kCoveredLevel);
  } else {
    image = camera_->Take(history_);
  }
  last_pixels_ = image.pixels;
  const Stamp stamp = image.stamp + FromSeconds(faults_.Value(Fault::Kind::kCameraClock, time));
  const Stamp arrival =
      image.arrival + FromSeconds(faults_.Value(Fault::Kind::kCameraDelayed, time));
  pending_.insert({arrival, {arrival, CameraFrame{stamp, image.pixels, image.encoding}}});
}

MountPose RobotSimulation::laser_mount() const {
  MountPose mount = scenario_.laser.mount;
  if (scenario_.laser.upside_down) mount.roll = M_PI;
  return mount;
}

MountPose RobotSimulation::camera_mount() const { return CalibratedMount(scenario_.camera); }

CameraLens RobotSimulation::camera_lens() const { return CalibratedLens(scenario_.camera); }

}  // namespace scan_image_slam
