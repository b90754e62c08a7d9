// What drivers send on bad days: no such scan stops the run, spoils the pose or is lost silently.
#include "pipeline_fixtures.h"

#include <limits>
#include <string>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

constexpr double kMaxDistance = 0.01;  // as in the tests of ordinary runs
constexpr double kMaxAngle = 0.005;
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

void ExpectFollowed(const PipelineRun& run, const TestDrive& drive, std::size_t scans) {
  ASSERT_EQ(run.results.size(), scans);
  for (const PipelineResult& result : run.results) EXPECT_TRUE(IsFinite(result));
  const PoseError largest = LargestError(run.results, drive);
  EXPECT_LT(largest.distance, kMaxDistance);
  EXPECT_LT(largest.angle, kMaxAngle);
}

/// A run in which scans are changed before they arrive.
template <typename Change>
void ExpectFollowedDespite(const TestDrive& drive, const Change& change) {
  PipelineRun run;
  int index = 0;
  ForEachScan(drive, 40, &run.pipeline, [&](double, LaserScan scan) {
    change(index++, &scan);
    run.Add(scan);
  });
  run.pipeline.Finish();
  ExpectFollowed(run, drive, 40);
}

class HostileRange : public ::testing::TestWithParam<float> {};

TEST_P(HostileRange, InEveryThirdBeamIsLeftOut) {
  ExpectFollowedDespite(TestDrive(), [](int index, LaserScan* scan) {
    for (std::size_t i = index % 3; i < scan->ranges.size(); i += 3) scan->ranges[i] = GetParam();
  });
}

TEST_P(HostileRange, InAllBeamsOfSomeScansIsBridgedByTheEncoders) {
  TestDrive drive;
  drive.encoder_scale = 1.0;
  ExpectFollowedDespite(drive, [](int index, LaserScan* scan) {
    if (index >= 10 && index < 15) scan->ranges.assign(scan->ranges.size(), GetParam());
  });
}

TEST_P(HostileRange, DrawsNothingIntoTheMap) {
  PipelineRun run;
  LaserScan scan;
  scan.stamp = kRunStart;
  scan.angle_min = -1.0;
  scan.angle_increment = 0.01;
  scan.range_min = 0.05;
  scan.range_max = 30.0;
  scan.ranges.assign(200, GetParam());
  run.Add(scan);
  run.pipeline.Finish();
  ASSERT_EQ(run.results.size(), 1U);
  EXPECT_EQ(run.results[0].match.points, 0);
  const OccupancyGrid& grid = run.pipeline.mapper().grid();
  for (int y = grid.box().y.begin; y < grid.box().y.end; ++y) {
    for (int x = grid.box().x.begin; x < grid.box().x.end; ++x) {
      EXPECT_EQ(grid.Occupancy(x, y), -1);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Values, HostileRange,
                         ::testing::Values(kNan, -kNan, kInfinity, -kInfinity, 0.0F, -0.0F, 0.001F,
                                           -1.0F, 65.533F, 3.0e38F, 1.0e-40F));

TEST(HostileScan, WithoutBeamsIsBridgedByTheEncoders) {
  TestDrive drive;
  drive.encoder_scale = 1.0;
  ExpectFollowedDespite(drive, [](int index, LaserScan* scan) {
    if (index >= 10 && index < 15) scan->ranges.clear();
  });
}

TEST(HostileScan, NothingButEmptyScansFollowsTheEncoders) {
  TestDrive drive;
  drive.encoder_scale = 1.0;
  ExpectFollowedDespite(drive, [](int, LaserScan* scan) { scan->ranges.clear(); });
}

TEST(HostileScan, EmptyAtFirstAreForgottenWhenTheLaserSees) {
  TestDrive drive;
  PipelineRun run;
  int index = 0;
  ForEachScan(drive, 60, &run.pipeline, [&](double, LaserScan scan) {
    if (index++ < 10) scan.ranges.clear();
    run.Add(scan);
  });
  run.pipeline.Finish();
  ASSERT_EQ(run.results.size(), 60U);
  run.results.erase(run.results.begin(), run.results.begin() + 11);
  const PoseError largest = LargestError(run.results, drive);
  EXPECT_LT(largest.distance, kMaxDistance);
  EXPECT_LT(largest.angle, kMaxAngle);
}

TEST(HostileScan, BeamCountsMayChange) {
  ExpectFollowedDespite(TestDrive(), [](int index, LaserScan* scan) {
    scan->ranges.resize(scan->ranges.size() - 7 * (index % 5));
    if (index % 4 != 1) return;
    // Half the beams at twice the increment.
    std::vector<float> half;
    for (std::size_t i = 0; i < scan->ranges.size(); i += 2) half.push_back(scan->ranges[i]);
    scan->ranges = half;
    scan->angle_increment *= 2.0;
  });
}

TEST(HostileScan, AClockwiseSweepIsASweep) {
  ExpectFollowedDespite(TestDrive(), [](int, LaserScan* scan) {
    scan->angle_min = scan->Bearing(scan->ranges.size() - 1);
    scan->angle_increment = -scan->angle_increment;
    std::reverse(scan->ranges.begin(), scan->ranges.end());
  });
}

TEST(HostileScan, ALaserUpsideDownIsALaser) {
  const TestDrive drive;
  PipelineRun run;
  Eigen::Isometry3d base_from_laser = Eigen::Isometry3d::Identity();
  base_from_laser.rotate(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()));
  run.pipeline.fusion().SetLaser(LaserMount::From(base_from_laser));
  ForEachScan(drive, 40, &run.pipeline, [&](double, LaserScan scan) {
    std::reverse(scan.ranges.begin(), scan.ranges.end());  // its bearings are symmetric
    run.Add(scan);
  });
  run.pipeline.Finish();
  ExpectFollowed(run, drive, 40);
}

TEST(HostileScan, ALaserWithItsZeroBehindIsALaser) {
  // The seam of its bearings is in the front of the robot, beyond pi.
  ExpectFollowedDespite(TestDrive(), [](int, LaserScan* scan) {
    std::rotate(scan->ranges.begin(), scan->ranges.begin() + 180, scan->ranges.end());
    scan->angle_min += M_PI;
  });
}

TEST(HostileScan, AllBeamsAtOneBearingDoNotHarm) {
  TestDrive drive;
  drive.encoder_scale = 1.0;
  ExpectFollowedDespite(drive, [](int index, LaserScan* scan) {
    if (index < 10 || index >= 13) return;
    scan->angle_increment = 0.0;
    scan->ranges.assign(50, scan->ranges[180]);
  });
}

TEST(HostileScan, InvertedLimitsHoldNoHit) {
  PipelineRun run;
  TestRandom random(1);
  LaserScan scan = TestDrive().ScanAt(0.0, &random);
  std::swap(scan.range_min, scan.range_max);
  run.Add(scan);
  run.pipeline.Finish();
  ASSERT_EQ(run.results.size(), 1U);
  EXPECT_EQ(run.results[0].match.points, 0);
}

/// Stamps, by scan; the laser and its encoders stand still.
std::size_t ResultsOf(const std::vector<Stamp>& stamps, int* dropped) {
  TestDrive drive;
  drive.velocity = {};
  PipelineRun run;
  TestRandom random(2);
  Stamp now = kRunStart;
  for (const Stamp stamp : stamps) {
    LaserScan scan = drive.ScanAt(0.0, &random);
    scan.stamp = stamp;
    run.pipeline.AddScan(scan, now += FromSeconds(0.1));
  }
  run.pipeline.Finish();
  for (std::size_t i = 0; i < run.results.size(); ++i) {
    EXPECT_TRUE(IsFinite(run.results[i]));
    ExpectPoseNear(run.results[i].pose.map_from_base, {}, kMaxDistance);
    if (i == 0) continue;
    EXPECT_GT(run.results[i].pose.stamp, run.results[i - 1].pose.stamp);
  }
  *dropped = run.pipeline.dropped();
  return run.results.size();
}

TEST(HostileStamp, ThatRepeatsIsDroppedAndCounted) {
  int dropped = 0;
  EXPECT_EQ(ResultsOf({kRunStart, kRunStart, kRunStart + 100, kRunStart + 100}, &dropped), 2U);
  EXPECT_EQ(dropped, 2);
}

TEST(HostileStamp, ThatGoesBackIsDroppedAndCounted) {
  int dropped = 0;
  const Stamp second = FromSeconds(1.0);
  EXPECT_EQ(ResultsOf({kRunStart, kRunStart + second, kRunStart + second / 2, kRunStart - second,
                       kRunStart + 2 * second},
                      &dropped),
            3U);
  EXPECT_EQ(dropped, 2);
}

TEST(HostileStamp, OfZeroIsAStamp) {
  int dropped = 0;
  EXPECT_EQ(ResultsOf({0, 0, FromSeconds(0.1), 0, FromSeconds(0.2)}, &dropped), 3U);
  EXPECT_EQ(dropped, 2);
}

TEST(HostileStamp, ANanosecondApartIsNoInfiniteVelocity) {
  int dropped = 0;
  std::vector<Stamp> stamps;
  for (int i = 0; i < 20; ++i) stamps.push_back(kRunStart + i);
  EXPECT_EQ(ResultsOf(stamps, &dropped), 20U);
  EXPECT_EQ(dropped, 0);
}

TEST(HostileStamp, AMicrosecondAfterTheLastIsNoVelocity) {
  int dropped = 0;
  std::vector<Stamp> stamps;
  for (int i = 0; i < 20; ++i) stamps.push_back(kRunStart + FromSeconds(0.1 * i));
  stamps[10] = stamps[9] + 1000;
  EXPECT_EQ(ResultsOf(stamps, &dropped), 20U);
}

TEST(HostileOdometry, StaleReadingsAreNotUsed) {
  const TestDrive drive;
  PipelineRun run;
  ForEachScan(drive, 40, &run.pipeline, [&](double seconds, const LaserScan& scan) {
    const Stamp stamp = kRunStart + FromSeconds(seconds);
    run.pipeline.AddOdometry(stamp, {50.0, 50.0, 3.0}, stamp);      // repeats
    run.pipeline.AddOdometry(stamp - 1, {50.0, 50.0, 3.0}, stamp);  // goes back
    run.pipeline.AddOdometry(0, {50.0, 50.0, 3.0}, stamp);
    run.Add(scan);
  });
  run.pipeline.Finish();
  ExpectFollowed(run, drive, 40);
}

}  // namespace
}  // namespace scan_image_slam
