#include "scan_image_slam/core/simulation/robot_simulation.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

constexpr char kWorlds[] = SCAN_IMAGE_SLAM_SOURCE_DIR "/config/worlds";

std::vector<std::string> ShippedWorlds() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(kWorlds)) {
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

Scenario Load(const std::string& name) {
  return LoadScenario(std::string(kWorlds) + "/" + name + ".yaml");
}

/// What a drive along a path was like.
struct Drive {
  double seconds = 0.0;
  double metres = 0.0;
  double clearance = 1e9;
  double turn_rate = 0.0;
  double speed = 0.0;
};

Drive DriveThrough(const Scenario& scenario, const std::string& path, int rounds = 1) {
  // Scans are not looked at: few are enough.
  Scenario quick = scenario;
  quick.laser.beams = 2;
  SimulationOptions options;
  options.images = false;
  options.path = path;
  options.rounds = rounds;
  RobotSimulation simulation(quick, options);
  Drive drive;
  Pose2 last = simulation.truth().world_from_base;
  while (const std::optional<SensorEvent> event = simulation.Next()) {
    const auto* truth = std::get_if<GroundTruth>(&event->data);
    if (truth == nullptr) continue;
    const Pose2& pose = truth->world_from_base;
    drive.seconds = Seconds(truth->stamp - options.start);
    const double step = (pose.translation() - last.translation()).norm();
    drive.metres += step;
    drive.speed = std::max(drive.speed, step / 0.025);
    drive.turn_rate =
        std::max(drive.turn_rate, std::abs(NormalizeAngle(pose.theta - last.theta)) / 0.025);
    drive.clearance = std::min(drive.clearance,
                               Clearance(scenario.world, pose.translation(), 1.2, drive.seconds));
    last = pose;
  }
  return drive;
}

class ShippedWorld : public testing::TestWithParam<std::string> {};

TEST_P(ShippedWorld, LoadsAndItsPathsKeepClearOfEverything) {
  const Scenario scenario = Load(GetParam());
  for (const RobotPath& path : scenario.paths) {
    const Drive drive = DriveThrough(scenario, path.name);
    EXPECT_GE(drive.clearance, 0.3) << path.name;
    EXPECT_GT(drive.metres, 10.0) << path.name;
    EXPECT_LT(drive.seconds, 1800.0) << path.name;
  }
}

INSTANTIATE_TEST_SUITE_P(All, ShippedWorld, testing::ValuesIn(ShippedWorlds()),
                         [](const auto& info) { return info.param; });

TEST(ShippedWorlds, AllThatAreDocumentedAreThere) {
  const std::vector<std::string> names = ShippedWorlds();
  for (const char* name : {"laboratory", "corridor", "ring", "hall_pillars", "cluttered_rooms",
                           "plain_corridor_doors_only", "corridor_posters_only",
                           "corridor_identical_doors", "corridor_dark"}) {
    EXPECT_EQ(std::count(names.begin(), names.end(), name), 1) << name;
  }
}

TEST(ShippedWorlds, TheLaboratoryIsDrivenAsInThePaper) {
  const Drive drive = DriveThrough(Load("laboratory"), "");
  EXPECT_GT(drive.seconds, 60.0);
  EXPECT_LT(drive.seconds, 95.0);
  EXPECT_LE(drive.speed * 0.025, 0.0151);                    // D = 15 mm
  EXPECT_LE(drive.turn_rate * 0.025, 0.201 * M_PI / 180.0);  // Phi = 0.2 deg
}

TEST(ShippedWorlds, TheCorridorIsDrivenDownAndBack) {
  const Drive drive = DriveThrough(Load("corridor"), "");
  EXPECT_NEAR(drive.metres, 109.0, 0.5);
}

TEST(ShippedWorlds, TheRingIsClosed) {
  const Drive drive = DriveThrough(Load("ring"), "");
  EXPECT_GT(drive.metres, 60.0);
  EXPECT_LT(drive.metres, 80.0);
}

TEST(ShippedWorlds, AnotherRoundGoesOnFromTheEndOfThePath) {
  const Scenario ring = Load("ring");
  const double once = DriveThrough(ring, "round").metres;
  // It ends 3 m ahead of where it began.
  EXPECT_NEAR(DriveThrough(ring, "round", 2).metres, 2.0 * once - 3.0, 0.1);
}

TEST(ShippedWorlds, FlushDecorationsAreNotSeenByTheLaser) {
  const Scenario bare = Load("corridor_shell");
  const Scenario decorated = Load("corridor");
  ASSERT_EQ(bare.world.walls.size(), decorated.world.walls.size());
  for (std::size_t i = 0; i < bare.world.walls.size(); ++i) {
    EXPECT_EQ(bare.world.walls[i].from, decorated.world.walls[i].from);
    EXPECT_EQ(bare.world.walls[i].to, decorated.world.walls[i].to);
  }
}

}  // namespace
}  // namespace scan_image_slam
