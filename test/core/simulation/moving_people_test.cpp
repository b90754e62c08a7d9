// What walks through the room while it is mapped must not stay in the map.
#include "plain_world.h"
#include "scan_image_slam/core/evaluation/map_quality.h"
#include "scan_image_slam/core/pipeline/slam_pipeline.h"
#include "scan_image_slam/core/simulation/robot_simulation.h"
#include "scan_image_slam/core/simulation/true_plan.h"

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

constexpr double kLeaving = 2.0;  // when somebody who stood in the room leaves [s]
constexpr double kLength = 14.0;  // of the run [s]

/// The robot drives through a room of 10 m by 4 m. Some metres ahead of it somebody stands when the
/// mapping begins, and leaves through a wall; somebody else then crosses the room.
Scenario RoomWithPeople() {
  Scenario scenario = PlainScenario();
  AddPlainWall(scenario.world, {8.5, 0.0}, {8.5, 1.2});
  AddPlainWall(scenario.world, {4.0, 3.2}, {5.0, 3.2});
  Person standing;
  standing.path = {{{7.2, 2.0}, kLeaving}, {{7.2, 5.0}, kLeaving + 2.5}};
  Person crossing;
  crossing.path = {{{7.8, 5.0}, 4.0}, {{7.8, -1.0}, 9.0}};
  scenario.world.people = {standing, crossing};
  return scenario;
}

struct Maps {
  MapImage early;  ///< while somebody still stands there
  MapImage end;
  std::vector<Pose2> world_from_base;
};

Maps MapOf(const Scenario& scenario) {
  SimulationOptions options;
  options.images = false;
  options.duration = kLength;
  RobotSimulation simulation(scenario, options);
  SlamPipeline pipeline(SlamOptions(), [](const PipelineResult&) {});
  pipeline.fusion().SetLaser(LaserMount::From(simulation.laser_mount().Transform()));
  Maps maps;
  while (const std::optional<SensorEvent> event = simulation.Next()) {
    if (const auto* scan = std::get_if<LaserScan>(&event->data)) {
      pipeline.AddScan(*scan, event->arrival);
    } else if (const auto* reading = std::get_if<OdometryReading>(&event->data)) {
      pipeline.AddOdometry(reading->stamp, reading->odom_from_base, event->arrival);
    } else if (const auto* truth = std::get_if<GroundTruth>(&event->data)) {
      maps.world_from_base.push_back(truth->world_from_base);
    }
    if (event->arrival < options.start + FromSeconds(kLeaving)) {
      maps.early = ToMapImage(pipeline.mapper().grid());
    }
  }
  pipeline.Finish();
  maps.end = ToMapImage(pipeline.mapper().grid());
  return maps;
}

class MovingPeople : public ::testing::Test {
 protected:
  MapQuality Judge(const MapImage& map, const Maps& maps) const {
    const TruePlan plan = SeenPlan(scenario_.world, scenario_.laser, maps.world_from_base, 0.05);
    return EvaluateMap(map, plan, maps.world_from_base.front(), MapQualityOptions());
  }

  /// Occupied cells of the map where people have walked, away from the walls.
  std::size_t Traces(const MapImage& map, const Maps& maps) const {
    std::size_t traces = 0;
    for (const Eigen::Vector2i& cell : Judge(map, maps).false_cells) {
      const Eigen::Vector2d centre(map.origin_x + (cell.x() + 0.5) * map.resolution,
                                   map.origin_y + (cell.y() + 0.5) * map.resolution);
      const Eigen::Vector2d in_world = maps.world_from_base.front() * centre;
      const bool on_way = in_world.x() > 6.7 && in_world.x() < 8.3;
      traces += on_way && in_world.y() > 0.2 && in_world.y() < 3.8 ? 1 : 0;
    }
    return traces;
  }

  const Scenario scenario_ = RoomWithPeople();
};

TEST_F(MovingPeople, LeaveNoTraceAfterTheyHaveGone) {
  const Maps maps = MapOf(scenario_);
  EXPECT_GE(Traces(maps.early, maps), 2U) << "not one cell for each leg while they are there";
  EXPECT_EQ(Traces(maps.end, maps), 0U);
}

TEST_F(MovingPeople, DoNotMakeTheMapLessPrecise) {
  Scenario empty = scenario_;
  empty.world.people.clear();
  const Maps with = MapOf(scenario_);
  const Maps without = MapOf(empty);
  const MapQuality judged = Judge(with.end, with);
  const MapQuality expected = Judge(without.end, without);
  EXPECT_LE(judged.false_cells.size(), expected.false_cells.size());
  EXPECT_GT(judged.Recall(), 0.98);
  EXPECT_GT(expected.Recall(), 0.98);
}

}  // namespace
}  // namespace scan_image_slam
