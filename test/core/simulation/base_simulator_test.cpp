#include "scan_image_slam/core/simulation/drive_simulator.h"
#include "scan_image_slam/core/simulation/encoder_simulator.h"
#include "scan_image_slam/core/simulation/path_follower.h"

#include <cmath>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

BaseSimulatorOptions IdealBase() { return Ideal(BaseSimulatorOptions{}, true); }

/// Drives with constant velocity and returns the last reading.
OdometryReading DriveConstantly(const BaseSimulatorOptions& options, double speed, double turn_rate,
                                double seconds, std::uint64_t seed = 1) {
  EncoderSimulator encoders(options, seed, 0);
  OdometryReading last;
  for (int i = 1; i <= static_cast<int>(seconds * 1000.0 + 0.5); ++i) {
    encoders.Follow({FromSeconds(0.001 * i), {}, speed, turn_rate});
  }
  while (encoders.NextReading() <= FromSeconds(seconds)) last = encoders.Read();
  return last;
}

TEST(DriveSimulator, KeepsItsLimits) {
  const BaseSimulatorOptions options = IdealBase();
  DriveSimulator drive(options, {}, 1);
  double last_speed = 0.0;
  for (int i = 1; i <= 3000; ++i) {
    drive.StepTo(FromSeconds(0.001 * i), {5.0, 5.0});
    EXPECT_LE(drive.state().speed, options.max_speed + 1e-12);
    EXPECT_LE(drive.state().turn_rate, options.max_turn_rate + 1e-12);
    EXPECT_LE(drive.state().speed - last_speed, options.acceleration * 0.001 + 1e-9);
    last_speed = drive.state().speed;
  }
  EXPECT_NEAR(drive.state().speed, options.max_speed, 1e-9);
}

TEST(DriveSimulator, DrivesArcs) {
  BaseSimulatorOptions options = IdealBase();
  options.acceleration = 50.0;
  options.turn_acceleration = 50.0;
  DriveSimulator drive(options, {}, 1);
  for (int i = 1; i <= 10000; ++i) drive.StepTo(FromSeconds(0.001 * i), {0.5, 0.1});
  // 5 m with 0.1 rad/s: 1 rad on a circle of 5 m radius, less a little for the start.
  EXPECT_NEAR(drive.state().world_from_base.theta, 1.0, 0.01);
  EXPECT_NEAR(drive.state().world_from_base.x, 5.0 * std::sin(1.0), 0.05);
  EXPECT_NEAR(drive.state().world_from_base.y, 5.0 * (1.0 - std::cos(1.0)), 0.05);
}

TEST(EncoderSimulator, IdealEncodersTellTheTruth) {
  const OdometryReading reading = DriveConstantly(IdealBase(), 0.5, 0.1, 10.0);
  EXPECT_NEAR(reading.odom_from_base.theta, 1.0, 1e-6);
  EXPECT_NEAR(reading.odom_from_base.x, 5.0 * std::sin(1.0), 1e-6);
}

TEST(EncoderSimulator, OnePercentOfRadiusIsOnePercentOfDistance) {
  BaseSimulatorOptions options = IdealBase();
  options.left_radius_error = 0.01;
  options.right_radius_error = 0.01;
  const OdometryReading reading = DriveConstantly(options, 0.5, 0.0, 20.0);
  EXPECT_NEAR(reading.odom_from_base.x, 10.1, 1e-6);
  EXPECT_NEAR(reading.odom_from_base.theta, 0.0, 1e-9);
}

TEST(EncoderSimulator, UnequalWheelsTurnTheOdometry) {
  BaseSimulatorOptions options = IdealBase();
  options.right_radius_error = 0.01;
  const OdometryReading reading = DriveConstantly(options, 0.5, 0.0, 20.0);
  EXPECT_NEAR(reading.odom_from_base.theta, 0.01 * 10.0 / options.wheel_base, 1e-6);
}

TEST(EncoderSimulator, AnAssumedBaseThatIsTooLongTurnsTooLittle) {
  BaseSimulatorOptions options = IdealBase();
  options.wheel_base_error = 0.02;
  const OdometryReading reading = DriveConstantly(options, 0.0, 0.1, 10.0);
  EXPECT_NEAR(reading.odom_from_base.theta, 1.0 / 1.02, 1e-6);
}

TEST(EncoderSimulator, RoundsToTenthsOfADegreeAndMillimetres) {
  BaseSimulatorOptions options = IdealBase();
  options.position_quantum = 0.001;
  options.heading_quantum = M_PI / 1800.0;
  const OdometryReading reading = DriveConstantly(options, 0.4567, 0.0765, 3.3);
  const double tenths = reading.odom_from_base.theta / options.heading_quantum;
  const double millimetres = 1000.0 * reading.odom_from_base.x;
  EXPECT_NEAR(tenths, std::round(tenths), 1e-6);
  EXPECT_NEAR(millimetres, std::round(millimetres), 1e-6);
  EXPECT_GT(reading.odom_from_base.x, 1.0);
}

TEST(EncoderSimulator, SlipGrowsWithTheSquareRootOfTheWay) {
  BaseSimulatorOptions options = IdealBase();
  options.slip_noise = 0.01;
  double squares = 0.0;
  constexpr int kRuns = 300;
  for (int run = 0; run < kRuns; ++run) {
    const OdometryReading reading = DriveConstantly(options, 0.5, 0.0, 8.0, run);
    squares += std::pow(reading.odom_from_base.theta, 2);
  }
  // Two wheels, each 0.01 sqrt(4 m), over the wheel base.
  const double expected = std::sqrt(2.0) * 0.01 * 2.0 / options.wheel_base;
  EXPECT_NEAR(std::sqrt(squares / kRuns), expected, 0.1 * expected);
}

TEST(EncoderSimulator, SlipsReportMotionThatIsNotThere) {
  BaseSimulatorOptions options = IdealBase();
  options.slip_rate = 0.5;
  options.slip_duration = 0.3;
  options.slip_speed = 0.2;
  const OdometryReading moving = DriveConstantly(options, 0.5, 0.0, 40.0);
  EXPECT_GT(std::abs(moving.odom_from_base.theta), 0.01);
  const OdometryReading standing = DriveConstantly(options, 0.0, 0.0, 40.0);
  EXPECT_EQ(standing.odom_from_base.theta, 0.0);
}

TEST(EncoderSimulator, ReadsAtItsRateAndStampsLater) {
  BaseSimulatorOptions options = IdealBase();
  options.odometry_delay = 0.008;
  options.odometry_latency = 0.001;
  EncoderSimulator encoders(options, 1, FromSeconds(10.0));
  EXPECT_EQ(encoders.NextReading(), FromSeconds(10.005));
  encoders.Follow({FromSeconds(10.005), {}, 0.3, 0.1});
  const OdometryReading reading = encoders.Read();
  EXPECT_EQ(reading.stamp, FromSeconds(10.013));
  EXPECT_EQ(reading.arrival, FromSeconds(10.014));
  EXPECT_NEAR(reading.speed, 0.3, 1e-6);
  EXPECT_NEAR(reading.turn_rate, 0.1, 1e-6);
  EXPECT_NEAR(Seconds(encoders.NextReading() - FromSeconds(10.005)), 1.0 / 30.0, 1e-8);
}

/// Follows a path with an ideal base; calls `each` with every state.
template <typename Each>
TrueState Follow(const RobotPath& path, const Each& each) {
  BaseSimulatorOptions options = IdealBase();
  options.max_speed = path.speed;
  options.max_turn_rate = path.turn_rate;
  PathFollower follower(path);
  DriveSimulator drive(options, {0, path.start, 0.0, 0.0}, 1);
  for (int i = 1; i <= 600000 && !follower.done(); ++i) {
    drive.StepTo(FromSeconds(0.001 * i), follower.Command(drive.state()));
    each(drive.state());
  }
  EXPECT_TRUE(follower.done());
  return drive.state();
}

TEST(PathFollower, DrivesThereAndBack) {
  RobotPath path;
  path.way_points = {{8.0, 0.0}, {0.0, 0.0}};
  double farthest = 0.0;
  const TrueState end = Follow(path, [&](const TrueState& state) {
    farthest = std::max(farthest, state.world_from_base.x);
    EXPECT_LT(std::abs(state.world_from_base.y), 0.05);
  });
  EXPECT_NEAR(farthest, 8.0, 0.03);
  EXPECT_NEAR(end.world_from_base.x, 0.0, 0.03);
  EXPECT_NEAR(std::abs(end.world_from_base.theta), M_PI, 0.05);
}

TEST(PathFollower, RoundsCornersAndKeepsTheTurnRate) {
  RobotPath path;
  path.way_points = {{4.0, 0.0}, {4.0, 4.0}};
  path.corner_radius = 1.0;
  double fastest = 0.0;
  double nearest_to_corner = 1e9;
  const TrueState end = Follow(path, [&](const TrueState& state) {
    fastest = std::max(fastest, state.turn_rate);
    nearest_to_corner = std::min(
        nearest_to_corner, (state.world_from_base.translation() - Eigen::Vector2d(4, 0)).norm());
  });
  EXPECT_LE(fastest, path.turn_rate + 1e-9);
  // A fillet of 1 m stays (sqrt(2) - 1) m away from the corner.
  EXPECT_NEAR(nearest_to_corner, std::sqrt(2.0) - 1.0, 0.05);
  EXPECT_NEAR((end.world_from_base.translation() - Eigen::Vector2d(4, 4)).norm(), 0.0, 0.03);
}

TEST(PathFollower, RefusesAPathThatStandsStill) {
  RobotPath path;
  path.way_points = {{1.0, 0.0}, {1.0, 0.01}};
  EXPECT_THROW(PathFollower{path}, std::invalid_argument);
}

}  // namespace
}  // namespace scan_image_slam
