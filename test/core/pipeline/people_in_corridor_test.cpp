// Along a plain corridor what little there is to see decides: people who walk there are to the
// laser and to the camera the best there is. They must not take the pose along.
#include "scan_image_slam/core/pipeline/slam_pipeline.h"
#include "scan_image_slam/core/simulation/camera_lens.h"
#include "scan_image_slam/core/simulation/robot_simulation.h"
#include "scan_image_slam/core/simulation/scenario.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

constexpr double kDuration = 14.0;  // [s]

/// The robot starts at (2.5, 1.2) and drives along x at 0.6 m/s.
Scenario Corridor(bool people) {
  Scenario scenario =
      LoadScenario(SCAN_IMAGE_SLAM_SOURCE_DIR "/config/worlds/plain_corridor_doors_only.yaml");
  scenario.camera.encoding = ImageEncoding::kMono8;
  if (!people) return scenario;
  Person ahead;  // as fast as the robot: to it they stand still
  ahead.path = {{{4.5, 1.5}, 1.5}, {{12.0, 1.5}, 14.0}};
  Person towards;  // and past it
  towards.path = {{{14.0, 0.6}, 0.0}, {{1.0, 0.6}, 11.0}};
  Person overtaking;
  overtaking.path = {{{1.0, 1.9}, 4.0}, {{13.0, 1.9}, 14.0}};
  double grey = 30.0;
  for (Person person : {ahead, towards, overtaking}) {
    Face cloth;
    cloth.colour = {grey, grey, grey};
    person.shirt = person.trousers = person.head = scenario.world.AddFace(cloth);
    scenario.world.people.push_back(person);
    grey += 50.0;
  }
  return scenario;
}

void SetCamera(const CameraSimulatorOptions& options, SlamPipeline* pipeline) {
  const CameraLens lens = CalibratedLens(options);
  CameraIntrinsics intrinsics;
  intrinsics.width = lens.width;
  intrinsics.height = lens.height;
  intrinsics.k = {lens.fx, 0.0, lens.cx, 0.0, lens.fy, lens.cy, 0.0, 0.0, 1.0};
  intrinsics.d.assign(lens.distortion.begin(), lens.distortion.end());
  Eigen::Isometry3d base_from_camera = CalibratedMount(options).Transform();
  base_from_camera.rotate(BodyFromOptical());
  pipeline->fusion().SetCamera(intrinsics, base_from_camera);
}

struct Result {
  std::vector<double> ways;  ///< of the live poses, along the corridor [m]
  double worst = 0.0;        ///< greatest error of them [m]
};

Result Drive(bool people, bool images) {
  SimulationOptions options;
  options.duration = kDuration;
  options.images = images;
  const Scenario scenario = Corridor(people);
  RobotSimulation simulation(scenario, options);
  std::map<Stamp, double> truth;
  std::map<Stamp, double> estimates;
  SlamPipeline pipeline(SlamOptions(), [&](const PipelineResult& result) {
    estimates[result.pose.stamp] = result.pose.map_from_base.x;
  });
  pipeline.fusion().SetLaser(LaserMount::From(simulation.laser_mount().Transform()));
  if (images) SetCamera(scenario.camera, &pipeline);
  while (const std::optional<SensorEvent> event = simulation.Next()) {
    if (const auto* scan = std::get_if<LaserScan>(&event->data)) {
      pipeline.AddScan(*scan, event->arrival);
    } else if (const auto* frame = std::get_if<CameraFrame>(&event->data)) {
      pipeline.AddImage({frame->stamp, frame->pixels, nullptr}, event->arrival);
    } else if (const auto* reading = std::get_if<OdometryReading>(&event->data)) {
      pipeline.AddOdometry(reading->stamp, reading->odom_from_base, event->arrival);
    } else if (const auto* pose = std::get_if<GroundTruth>(&event->data)) {
      truth[pose->stamp] = pose->world_from_base.x;
    }
  }
  pipeline.Finish();
  Result run;
  const double offset = estimates.begin()->second - truth.at(estimates.begin()->first);
  for (const auto& [stamp, way] : estimates) {
    run.ways.push_back(way);
    run.worst = std::max(run.worst, std::abs(way - offset - truth.at(stamp)));
  }
  return run;
}

TEST(PeopleInCorridor, DoNotMoveThePoseByLaserAndEncoders) {
  const Result with = Drive(/*people=*/true, /*images=*/false);
  const Result without = Drive(/*people=*/false, /*images=*/false);
  ASSERT_EQ(with.ways.size(), without.ways.size());
  for (std::size_t i = 0; i < with.ways.size(); ++i) {
    ASSERT_NEAR(with.ways[i], without.ways[i], 0.005) << "scan " << i;
  }
}

TEST(PeopleInCorridor, LetTheCameraTellTheWay) {
  const Result with_camera = Drive(/*people=*/true, /*images=*/true);
  const Result encoders = Drive(/*people=*/true, /*images=*/false);
  EXPECT_LT(with_camera.worst, 0.04);
  EXPECT_LT(with_camera.worst, 0.5 * encoders.worst);
}

}  // namespace
}  // namespace scan_image_slam
