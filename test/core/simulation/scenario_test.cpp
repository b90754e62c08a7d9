#include "scan_image_slam/core/simulation/scenario.h"

#include "scan_image_slam/core/config/yaml_section.h"
#include "support_folder.h"

#include <cmath>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

class ScenarioFiles : public testing::Test {
 protected:
  /// The error of loading this text, without the folder's name.
  std::string ErrorOf(const std::string& text) const {
    const std::string path = folder_.Write("world.yaml", text);
    try {
      LoadScenario(path);
    } catch (const YamlError& error) {
      return folder_.WithoutPath(error.what());
    }
    return "no error";
  }

  const TemporaryFolder folder_;
};

const char kPath[] = "paths: [{start: [0, 0], way_points: [[5, 0]]}]\n";

TEST_F(ScenarioFiles, OverridesSensorOptionsByName) {
  const Scenario scenario = LoadScenario(folder_.Write(
      "world.yaml", std::string(kPath) +
                        "sensors:\n"
                        "  laser: {rate: 10, beams: 682, angle_increment_deg: 0.3515625,\n"
                        "          steps_per_turn: 1024, range_max: 5.6, no_return: zero}\n"
                        "  camera: {yaw_deg: 5, encoding: mono8}\n"
                        "  base: {slip_rate: 0}\n"));
  EXPECT_DOUBLE_EQ(scenario.laser.rate, 10.0);
  EXPECT_EQ(scenario.laser.beams, 682);
  EXPECT_EQ(scenario.laser.no_return, NoReturn::kZero);
  EXPECT_NEAR(scenario.laser.angle_increment, 0.3515625 * M_PI / 180.0, 1e-12);
  EXPECT_NEAR(scenario.camera.mount.yaw, 5.0 * M_PI / 180.0, 1e-12);
  EXPECT_EQ(scenario.camera.encoding, ImageEncoding::kMono8);
  EXPECT_EQ(scenario.base.slip_rate, 0.0);
}

TEST_F(ScenarioFiles, IncludesAddAndOverride) {
  folder_.Write("base.yaml", std::string(kPath) +
                                 "walls:\n  - {id: w, from: [0, 1], to: [9, 1]}\n"
                                 "sensors: {laser: {rate: 10}, camera: {rate: 15}}\n");
  const Scenario scenario =
      LoadScenario(folder_.Write("world.yaml",
                                 "include: base.yaml\n"
                                 "decorations:\n  - {kind: door, wall: w, at: 3}\n"
                                 "sensors: {laser: {rate: 20}}\n"
                                 "paths: [{name: mine, start: [1, 0], way_points: [[2, 0]]}]\n"));
  EXPECT_EQ(scenario.world.walls.size(), 1U);
  EXPECT_EQ(scenario.world.faces[0].decorations.size(), 1U);
  EXPECT_DOUBLE_EQ(scenario.laser.rate, 20.0);
  EXPECT_DOUBLE_EQ(scenario.camera.rate, 15.0);
  ASSERT_EQ(scenario.paths.size(), 2U);
  EXPECT_EQ(FindPath(scenario, "").name, "mine");
  EXPECT_DOUBLE_EQ(FindPath(scenario, "default").start.x, 0.0);
}

TEST_F(ScenarioFiles, ReadsFaults) {
  const Scenario scenario = LoadScenario(
      folder_.Write("world.yaml", std::string(kPath) +
                                      "faults:\n"
                                      "  - {kind: camera_delayed, from: 1, to: 2, delay: 0.3}\n"
                                      "  - {kind: encoders_slip, from: 3, to: 4, angle_deg: 90}\n"
                                      "  - {kind: encoders_reset, from: 5}\n"));
  ASSERT_EQ(scenario.faults.size(), 3U);
  EXPECT_EQ(scenario.faults[0].kind, Fault::Kind::kCameraDelayed);
  EXPECT_DOUBLE_EQ(scenario.faults[0].value, 0.3);
  EXPECT_NEAR(scenario.faults[1].value, M_PI_2, 1e-12);
  EXPECT_EQ(scenario.faults[2].kind, Fault::Kind::kEncodersReset);
}

TEST_F(ScenarioFiles, ErrorsNameFileLineAndKey) {
  const std::string path(kPath);
  EXPECT_EQ(ErrorOf(path + "walls: []\nlamp: 1\n"), "world.yaml:3: key 'lamp': is not known");
  EXPECT_EQ(ErrorOf(path + "sensors:\n  laser: {rat: 10}\n"),
            "world.yaml:3: key 'sensors.laser.rat': is not known");
  EXPECT_EQ(ErrorOf(path + "sensors:\n  laser:\n    range_stddev: -1\n"),
            "world.yaml:4: key 'sensors.laser.range_stddev': is -1, must be in [0, 1]");
  EXPECT_EQ(ErrorOf(path + "sensors:\n  camera: {exposure: 0.1}\n"),
            "world.yaml:3: key 'sensors.camera': exposure must be shorter than the time between "
            "two images");
  EXPECT_EQ(ErrorOf(path + "faults:\n  - {kind: camera_off, from: 5, to: 4}\n"),
            "world.yaml:3: key 'faults[0].to': must be later than 'from'");
  EXPECT_EQ(ErrorOf(path + "faults:\n  - {kind: camera_off, from: 1, to: 4, delay: 3}\n"),
            "world.yaml:3: key 'faults[0].delay': is not known");
  EXPECT_EQ(ErrorOf("paths: [{start: [0, 0], way_points: [[0, 0]]}]"),
            "world.yaml:1: key 'paths[0].way_points': two way points are at the same place");
  EXPECT_EQ(ErrorOf("walls: []\n"), "world.yaml:1: key 'paths': is missing");
}

TEST_F(ScenarioFiles, RefusesIncludesThatAreMissingOrGoInCircles) {
  EXPECT_NE(ErrorOf("include: nowhere.yaml\n").find("does not exist"), std::string::npos);
  EXPECT_NE(ErrorOf("include: world.yaml\n").find("circle"), std::string::npos);
}

TEST(Options, EveryNumberIsChecked) {
  LaserSimulatorOptions laser;
  EXPECT_NO_THROW(laser.Validate());
  laser.beam_width = std::nan("");
  EXPECT_THROW(laser.Validate(), std::invalid_argument);
  CameraSimulatorOptions camera;
  EXPECT_NO_THROW(camera.Validate());
  camera.width = 0;
  EXPECT_THROW(camera.Validate(), std::invalid_argument);
  BaseSimulatorOptions base;
  EXPECT_NO_THROW(base.Validate());
  base.wheel_base = 0.0;
  EXPECT_THROW(base.Validate(), std::invalid_argument);
}

TEST(Options, IdealSensorsAreValidAndWithoutNoise) {
  const LaserSimulatorOptions laser = Ideal(LaserSimulatorOptions{});
  EXPECT_NO_THROW(laser.Validate());
  EXPECT_EQ(laser.range_stddev + laser.quantum + laser.drop_rate + laser.incidence_bias, 0.0);
  const CameraSimulatorOptions camera = Ideal(CameraSimulatorOptions{});
  EXPECT_NO_THROW(camera.Validate());
  EXPECT_EQ(camera.read_noise + camera.shot_noise + camera.blur, 0.0);
  EXPECT_EQ(Ideal(BaseSimulatorOptions{}, true).left_radius_error, 0.0);
  EXPECT_EQ(Ideal(BaseSimulatorOptions{}, false).left_radius_error,
            BaseSimulatorOptions{}.left_radius_error);
}

}  // namespace
}  // namespace scan_image_slam
