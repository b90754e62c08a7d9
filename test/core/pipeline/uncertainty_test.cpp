#include "scan_image_slam/core/pipeline/slam_pipeline.h"
#include "scan_image_slam/core/simulation/robot_simulation.h"
#include "scan_image_slam/core/simulation/scenario.h"

#include <cstdint>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

constexpr int kRuns = 20;
constexpr double kDuration = 5.0;  // [s]
constexpr double kStartUp = 1.0;   // of the robot, at rest at first [s]

/// Poses of a laser and encoders with all their errors, and the true ones.
struct Drive {
  std::map<Stamp, Pose2> truth;  ///< world_from_base
  std::vector<MapPose> poses;

  Drive(const std::string& world, std::uint64_t seed) {
    SimulationOptions options;
    options.seed = seed;
    options.duration = kDuration;
    options.images = false;
    RobotSimulation simulation(
        LoadScenario(SCAN_IMAGE_SLAM_SOURCE_DIR "/config/worlds/" + world + ".yaml"), options);
    SlamPipeline pipeline(SlamOptions(),
                          [this](const PipelineResult& result) { poses.push_back(result.pose); });
    pipeline.fusion().SetLaser(LaserMount::From(simulation.laser_mount().Transform()));
    while (const std::optional<SensorEvent> event = simulation.Next()) {
      if (const auto* scan = std::get_if<LaserScan>(&event->data)) {
        pipeline.AddScan(*scan, event->arrival);
      } else if (const auto* reading = std::get_if<OdometryReading>(&event->data)) {
        pipeline.AddOdometry(reading->stamp, reading->odom_from_base, event->arrival);
      } else if (const auto* true_pose = std::get_if<GroundTruth>(&event->data)) {
        truth[true_pose->stamp] = true_pose->world_from_base;
      }
    }
    pipeline.Finish();
  }

  /// Mean of the squared errors, in standard deviations as the poses tell them.
  double MeanNormalizedError() const {
    const Pose2 map_from_world =
        poses.front().map_from_base * truth.at(poses.front().stamp).Inverse();
    double sum = 0.0;
    int count = 0;
    for (const MapPose& pose : poses) {
      if (Seconds(pose.stamp - poses.front().stamp) < kStartUp) continue;
      const Eigen::Vector3d error =
          (pose.map_from_base.Inverse() * map_from_world * truth.at(pose.stamp)).coordinates();
      sum += error.dot(pose.covariance.inverse() * error);
      ++count;
    }
    return sum / count;
  }
};

// The normalised estimation error squared of honest poses is chi-squared with three degrees of
// freedom. The mean over 20 runs is then within 40.5 / 20 and 83.3 / 20 in 95 % of cases, and that
// of means along the runs more often.
class PoseUncertainty : public testing::TestWithParam<std::string> {};

TEST_P(PoseUncertainty, IsThatOfTheErrors) {
  double sum = 0.0;
  for (int seed = 1; seed <= kRuns; ++seed) {
    const Drive drive(GetParam(), static_cast<std::uint64_t>(seed));
    ASSERT_GT(drive.poses.size(), 100U);
    sum += drive.MeanNormalizedError();
  }
  EXPECT_GT(sum / kRuns, 40.5 / kRuns);
  EXPECT_LT(sum / kRuns, 83.3 / kRuns);
}

INSTANTIATE_TEST_SUITE_P(Worlds, PoseUncertainty, testing::Values("laboratory", "ring"));

}  // namespace
}  // namespace scan_image_slam
