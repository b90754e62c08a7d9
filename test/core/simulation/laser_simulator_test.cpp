#include "scan_image_slam/core/simulation/laser_simulator.h"

#include "plain_world.h"

#include <cmath>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

LaserSimulatorOptions IdealLaser() {
  LaserSimulatorOptions options = Ideal(LaserSimulatorOptions{});
  options.mount.x = 0.0;
  return options;
}

World WallAhead(double distance, LaserReturn laser = LaserReturn::kNormal) {
  World world = EmptyWorld();
  AddPlainWall(world, {distance, -50.0}, {distance, 50.0});
  world.walls[0].laser = laser;
  return world;
}

SimulatedScan Measure(const World& world, const LaserSimulatorOptions& options,
                      const MotionHistory& history) {
  return LaserSimulator(world, options, 1, 0).Measure(history);
}

SimulatedScan MeasureAtRest(const World& world, const LaserSimulatorOptions& options,
                            const Pose2& pose = {}) {
  return Measure(world, options, ConstantMotion(pose, 0.0, 0.0));
}

std::size_t BeamAt(const LaserScan& scan, double bearing) {
  return static_cast<std::size_t>(std::lround((bearing - scan.angle_min) / scan.angle_increment));
}

TEST(LaserSimulator, MeasuresTheDistanceOfAWall) {
  const World world = WallAhead(5.0);
  LaserSimulatorOptions options = IdealLaser();
  options.mount.x = 0.15;
  const LaserScan scan = MeasureAtRest(world, options, {1.0, 2.0, 0.0}).scan;
  ASSERT_EQ(scan.ranges.size(), 1081U);
  EXPECT_NEAR(scan.ranges[540], 5.0 - 1.0 - 0.15, 1e-6);
  EXPECT_NEAR(scan.ranges[BeamAt(scan, M_PI / 3.0)], 3.85 / 0.5, 1e-5);
  EXPECT_TRUE(std::isnan(scan.ranges[BeamAt(scan, 2.0)]));
}

TEST(LaserSimulator, TimesAreThoseOfTheUtm30) {
  const World world = WallAhead(5.0);
  LaserSimulator laser(world, IdealLaser(), 1, FromSeconds(100.0));
  const MotionHistory history = ConstantMotion({}, 0.0, 0.0);
  const SimulatedScan first = laser.Measure(history);
  const SimulatedScan second = laser.Measure(history);
  EXPECT_NEAR(first.scan.time_increment, 1.7361e-5, 1e-9);
  EXPECT_EQ(first.scan.stamp, FromSeconds(100.0));
  EXPECT_NEAR(Seconds(first.complete - first.scan.stamp), 0.01875, 1e-8);
  EXPECT_EQ(second.scan.stamp - first.scan.stamp, FromSeconds(0.025));
  EXPECT_EQ(first.arrival - first.complete, FromSeconds(0.004));
}

TEST(LaserSimulator, ATurningRobotSeesTheWallSkewed) {
  const World world = WallAhead(5.0);
  constexpr double kTurnRate = 1.0;
  const LaserScan scan = Measure(world, IdealLaser(), ConstantMotion({}, 0.0, kTurnRate)).scan;
  for (std::size_t beam = 300; beam < 780; beam += 20) {
    const double time = static_cast<double>(beam) * scan.time_increment;
    const double bearing = scan.Bearing(beam) + kTurnRate * time;
    EXPECT_NEAR(scan.ranges[beam], 5.0 / std::cos(bearing), 1e-4) << beam;
  }
}

TEST(LaserSimulator, ADrivingRobotComesNearerDuringTheSweep) {
  const World world = WallAhead(5.0);
  constexpr double kSpeed = 2.0;
  const LaserScan scan = Measure(world, IdealLaser(), ConstantMotion({}, kSpeed, 0.0)).scan;
  for (std::size_t beam = 300; beam < 780; beam += 20) {
    const double time = static_cast<double>(beam) * scan.time_increment;
    EXPECT_NEAR(scan.ranges[beam], (5.0 - kSpeed * time) / std::cos(scan.Bearing(beam)), 1e-4);
  }
}

TEST(LaserSimulator, CullingFindsAllThatABruteForceFinds) {
  World world = PlainRoom(9.0, 7.0);
  for (int i = 0; i < 60; ++i) {
    const Eigen::Vector2d at(1.0 + 0.11 * i, 1.0 + std::fmod(1.7 * i, 5.0));
    AddPlainWall(world, at, at + Eigen::Vector2d(0.3 * std::cos(i), 0.3 * std::sin(i)));
  }
  const Pose2 start{4.0, 3.2, 2.9};
  const LaserScan scan = Measure(world, IdealLaser(), ConstantMotion(start, 1.5, 4.0)).scan;
  for (std::size_t beam = 0; beam < scan.ranges.size(); ++beam) {
    const double time = static_cast<double>(beam) * scan.time_increment;
    const Pose2 pose = start * Arc(1.5 * time, 4.0 * time);
    const double bearing = pose.theta + scan.Bearing(beam);
    const Eigen::Vector2d ray(std::cos(bearing), std::sin(bearing));
    double nearest = 1e9;
    for (const Wall& wall : world.walls) {
      Eigen::Matrix2d m;
      m.col(0) = ray;
      m.col(1) = wall.from - wall.to;
      const Eigen::Vector2d solved = m.inverse() * (wall.from - pose.translation());
      if (solved.x() > 0.0 && solved.y() >= 0.0 && solved.y() <= 1.0) {
        nearest = std::min(nearest, solved.x());
      }
    }
    // A beam that just touches the end of a wall may see what is behind.
    if (std::abs(scan.ranges[beam] - nearest) > 1e-3) {
      const double nudge = 1e-4;
      bool touches = false;
      for (const Wall& wall : world.walls) {
        for (const Eigen::Vector2d& end : {wall.from, wall.to}) {
          const Eigen::Vector2d way = end - pose.translation();
          const double off = std::abs(ray.x() * way.y() - ray.y() * way.x()) / way.norm();
          touches = touches || (off < nudge && ray.dot(way) > 0.0);
        }
      }
      EXPECT_TRUE(touches) << "beam " << beam;
    }
  }
}

TEST(LaserSimulator, UpsideDownTurnsTheOtherWay) {
  World world = EmptyWorld();
  AddPlainWall(world, {-50.0, 2.0}, {50.0, 2.0});
  LaserSimulatorOptions options = IdealLaser();
  const LaserScan upright = MeasureAtRest(world, options).scan;
  options.upside_down = true;
  const LaserScan hanging = MeasureAtRest(world, options).scan;
  EXPECT_NEAR(upright.ranges[BeamAt(upright, M_PI_2)], 2.0, 1e-6);
  EXPECT_TRUE(std::isnan(upright.ranges[BeamAt(upright, -M_PI_2)]));
  EXPECT_NEAR(hanging.ranges[BeamAt(hanging, -M_PI_2)], 2.0, 1e-6);
  EXPECT_TRUE(std::isnan(hanging.ranges[BeamAt(hanging, M_PI_2)]));
}

TEST(LaserSimulator, CodesWhatDoesNotComeBack) {
  const World world = WallAhead(40.0);
  LaserSimulatorOptions options = IdealLaser();
  const auto ahead = [&](NoReturn code) {
    options.no_return = code;
    return MeasureAtRest(world, options).scan.ranges[540];
  };
  EXPECT_TRUE(std::isnan(ahead(NoReturn::kNan)));
  EXPECT_TRUE(std::isinf(ahead(NoReturn::kInfinity)));
  EXPECT_FLOAT_EQ(ahead(NoReturn::kOneMillimetre), 0.001F);
  EXPECT_FLOAT_EQ(ahead(NoReturn::kZero), 0.0F);
}

TEST(LaserSimulator, RoundsToMillimetres) {
  const World world = WallAhead(5.0003);
  LaserSimulatorOptions options = IdealLaser();
  options.quantum = 0.001;
  const LaserScan scan = MeasureAtRest(world, options).scan;
  EXPECT_FLOAT_EQ(scan.ranges[540], 5.0F);
  for (std::size_t beam = 400; beam < 680; ++beam) {
    const double thousandths = 1000.0 * scan.ranges[beam];
    EXPECT_NEAR(thousandths, std::round(thousandths), 1e-3);
  }
}

TEST(LaserSimulator, NoiseHasTheStandardDeviationOfTheDataSheet) {
  for (const auto& [distance, stddev] : {std::pair{4.0, 0.010}, std::pair{25.0, 0.017}}) {
    const World world = WallAhead(distance);
    LaserSimulatorOptions options;
    options.mount.x = 0.0;
    options.incidence_bias = 0.0;
    options.grazing_noise = 0.0;
    options.drop_rate = 0.0;
    LaserSimulator laser(world, options, 7, 0);
    const MotionHistory history = ConstantMotion({}, 0.0, 0.0);
    double squares = 0.0;
    int count = 0;
    for (int k = 0; k < 40; ++k) {
      const LaserScan scan = laser.Measure(history).scan;
      for (std::size_t beam = 500; beam <= 580; ++beam, ++count) {
        const double error = scan.ranges[beam] - distance / std::cos(scan.Bearing(beam));
        squares += error * error;
      }
    }
    EXPECT_NEAR(std::sqrt(squares / count), stddev, 0.0006) << distance;
  }
}

/// Ranges between a wall at 3.5 m and a narrow one in front of it, at 3 m.
int RangesInBetween(const LaserSimulatorOptions& options, double depth) {
  World world = WallAhead(3.0 + depth);
  AddPlainWall(world, {3.0, -0.404}, {3.0, 0.3963});
  const LaserScan scan = MeasureAtRest(world, options).scan;
  int between = 0;
  for (std::size_t beam = 480; beam <= 600; ++beam) {
    const double ahead = scan.ranges[beam] * std::cos(scan.Bearing(beam));
    between += ahead > 3.04 && ahead < 2.96 + depth ? 1 : 0;
  }
  return between;
}

TEST(LaserSimulator, MixesRangesAtTheEdgesOfNearThings) {
  LaserSimulatorOptions options = IdealLaser();
  EXPECT_EQ(RangesInBetween(options, 0.5), 0);
  options.mixed_pixels = true;
  EXPECT_GE(RangesInBetween(options, 0.5), 1);
  EXPECT_LE(RangesInBetween(options, 0.5), 4);
  EXPECT_EQ(RangesInBetween(options, 2.0), 0);
}

TEST(LaserSimulator, GlassReturnsOnlyStraightOn) {
  World world = WallAhead(3.0, LaserReturn::kGlass);
  AddPlainWall(world, {6.0, -50.0}, {6.0, 50.0});
  const LaserScan scan = MeasureAtRest(world, IdealLaser()).scan;
  EXPECT_NEAR(scan.ranges[540], 3.0, 1e-6);
  int through = 0;
  for (std::size_t beam = 600; beam < 700; ++beam) {
    through += std::abs(scan.ranges[beam] * std::cos(scan.Bearing(beam)) - 6.0) < 1e-4 ? 1 : 0;
  }
  EXPECT_GT(through, 90);
}

TEST(LaserSimulator, InvisibleAndDarkWalls) {
  World invisible = WallAhead(3.0, LaserReturn::kInvisible);
  AddPlainWall(invisible, {6.0, -50.0}, {6.0, 50.0});
  EXPECT_NEAR(MeasureAtRest(invisible, IdealLaser()).scan.ranges[540], 6.0, 1e-6);

  LaserSimulatorOptions options = IdealLaser();
  options.dark_bias = 0.01;
  options.dark_range = 8.0;
  EXPECT_NEAR(MeasureAtRest(WallAhead(5.0, LaserReturn::kDark), options).scan.ranges[540], 5.01,
              1e-6);
  EXPECT_TRUE(
      std::isnan(MeasureAtRest(WallAhead(9.0, LaserReturn::kDark), options).scan.ranges[540]));
}

TEST(LaserSimulator, SeesOnlyWhatReachesItsHeight) {
  World world = WallAhead(3.0);
  world.walls[0].bottom = 0.5;
  EXPECT_TRUE(std::isnan(MeasureAtRest(world, IdealLaser()).scan.ranges[540]));
  world.walls[0].bottom = 0.0;
  world.walls[0].top = 0.2;
  EXPECT_TRUE(std::isnan(MeasureAtRest(world, IdealLaser()).scan.ranges[540]));
}

TEST(LaserSimulator, SeesTheLegsOfAPerson) {
  World world = WallAhead(5.0);
  Person person;
  person.path = {{{2.0, 0.0}, 0.0}};
  world.people.push_back(person);
  const LaserScan scan = MeasureAtRest(world, IdealLaser()).scan;
  // Two legs of 7 cm radius, 11 cm to the left and right of the middle; the person looks along x.
  const std::size_t left = BeamAt(scan, std::atan2(0.11, 2.0));
  const std::size_t right = BeamAt(scan, std::atan2(-0.11, 2.0));
  EXPECT_NEAR(scan.ranges[left], std::hypot(2.0, 0.11) - 0.07, 2e-3);
  EXPECT_NEAR(scan.ranges[right], std::hypot(2.0, 0.11) - 0.07, 2e-3);
  EXPECT_NEAR(scan.ranges[540], 5.0, 1e-6);  // between the legs
}

TEST(LaserSimulator, LosesGrazingReturns) {
  World world = EmptyWorld();
  AddPlainWall(world, {0.0, 0.5}, {29.0, 0.5});
  LaserSimulatorOptions options = IdealLaser();
  options.range_max = 100.0;
  const auto lost = [&] {
    const LaserScan scan = MeasureAtRest(world, options).scan;
    int count = 0;
    // Incidence of 89 to 86 degrees.
    for (std::size_t beam = BeamAt(scan, 0.0180); beam <= BeamAt(scan, 0.07); ++beam) {
      count += std::isnan(scan.ranges[beam]) ? 1 : 0;
    }
    return count;
  };
  EXPECT_EQ(lost(), 0);
  options.grazing_drop_angle = 1.45;
  EXPECT_GE(lost(), 2);
}

TEST(LaserSimulator, OtherLasersByOptions) {
  LaserSimulatorOptions sick = IdealLaser();
  sick.beams = 181;
  sick.angle_min = -M_PI_2;
  sick.angle_increment = M_PI / 180.0;
  sick.steps_per_turn = 360.0;
  sick.rate = 75.0;
  sick.range_max = 80.0;
  const World world = WallAhead(50.0);
  const LaserScan scan = MeasureAtRest(world, sick).scan;
  ASSERT_EQ(scan.ranges.size(), 181U);
  EXPECT_NEAR(scan.ranges[90], 50.0, 1e-5);
  EXPECT_NEAR(scan.time_increment, 1.0 / 75.0 / 360.0, 1e-12);
}

TEST(LaserSimulator, RefusesWrongOptionsByName) {
  const World world = WallAhead(5.0);
  LaserSimulatorOptions options;
  options.range_stddev = -1.0;
  try {
    LaserSimulator laser(world, options, 1, 0);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("range_stddev"), std::string::npos);
  }
}

}  // namespace
}  // namespace scan_image_slam
