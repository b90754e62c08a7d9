#include "scan_image_slam/core/pipeline/slam_pipeline.h"

#include "pipeline_fixtures.h"

#include <cstring>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

// The bound of the tests: the standard deviation of a single range, 10 mm, and the angle that this
// makes at 2 m. A scan of hundreds of beams in a known room does not leave more.
constexpr double kMaxDistance = 0.01;
constexpr double kMaxAngle = 0.005;

TEST(SlamPipeline, FollowsTheRobotThroughARoomWithEncodersThatSlip) {
  const TestDrive drive;
  PipelineRun run;
  run.Drive(drive, 60);
  ASSERT_EQ(run.results.size(), 60U);
  const PoseError largest = LargestError(run.results, drive);
  EXPECT_LT(largest.distance, kMaxDistance);
  EXPECT_LT(largest.angle, kMaxAngle);
  // The encoders alone: 5 % of 2.36 m.
  const Pose2 by_encoders = drive.OdomAt(5.9);
  const Pose2 truth = drive.start.Inverse() * drive.PoseAt(5.9);
  EXPECT_GT((by_encoders.translation() - truth.translation()).norm(), 10.0 * kMaxDistance);
}

TEST(SlamPipeline, FollowsTheRobotWithoutEncoders) {
  TestDrive drive;
  drive.has_encoders = false;
  PipelineRun run;
  run.Drive(drive, 60);
  ASSERT_EQ(run.results.size(), 60U);
  const PoseError largest = LargestError(run.results, drive);
  EXPECT_LT(largest.distance, kMaxDistance);
  EXPECT_LT(largest.angle, kMaxAngle);
  for (const PipelineResult& result : run.results) {
    EXPECT_EQ(result.match.mode, MatchMode::kLaserOnly);
    EXPECT_FALSE(result.pose.map_from_odom);
  }
}

TEST(SlamPipeline, WithoutAnImageItIsLaserOnly) {
  PipelineRun run;
  run.Drive(TestDrive(), 10);
  for (const PipelineResult& result : run.results) {
    EXPECT_FALSE(result.model.has_image);
    EXPECT_EQ(result.match.mode, MatchMode::kNoCamera);
    EXPECT_TRUE(result.model.edges.empty());
  }
}

TEST(SlamPipeline, AddsTheWallsOfTheRoomToTheMap) {
  const TestDrive drive;
  PipelineRun run;
  run.Drive(drive, 60);
  // Beside the walls nothing is occupied: cells of 5 cm, and the noise of a range.
  const OccupancyGrid& grid = run.pipeline.mapper().grid();
  const Pose2 room_from_map = drive.start;
  int walls = 0;
  int beside = 0;
  for (int y = grid.box().y.begin; y < grid.box().y.end; ++y) {
    for (int x = grid.box().x.begin; x < grid.box().x.end; ++x) {
      if (grid.Occupancy(x, y) < 65) continue;
      const Eigen::Vector2d p = room_from_map * Eigen::Vector2d(0.05 * (x + 0.5), 0.05 * (y + 0.5));
      double nearest = 1e9;
      for (const RoomWall& wall : drive.room) {
        const Eigen::Vector2d way = wall.to - wall.from;
        const double along = std::clamp((p - wall.from).dot(way) / way.squaredNorm(), 0.0, 1.0);
        nearest = std::min(nearest, (wall.from + along * way - p).norm());
      }
      ++(nearest < 0.05 * M_SQRT1_2 + 4.0 * 0.01 ? walls : beside);
    }
  }
  EXPECT_GT(walls, 300);
  EXPECT_EQ(beside, 0);
}

TEST(SlamPipeline, TheOrderOfTheStagesIsThatOfTheNodes) {
  std::vector<Stage> stages;
  SlamPipeline pipeline(
      SlamOptions(), [](const PipelineResult&) {},
      [&](Stage stage, const std::function<void()>& work) {
        stages.push_back(stage);
        work();
      });
  TestRandom random(1);
  pipeline.AddScan(TestDrive().ScanAt(0.0, &random), kRunStart);
  pipeline.Finish();
  EXPECT_EQ(stages, (std::vector<Stage>{Stage::kFusion, Stage::kMatch, Stage::kMap, Stage::kLoop}));
}

bool SameBytes(const Pose2& a, const Pose2& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

TEST(SlamPipeline, TheSameInputTwiceGivesTheSameBits) {
  PipelineRun a;
  PipelineRun b;
  a.Drive(TestDrive(), 30);
  b.Drive(TestDrive(), 30);
  ASSERT_EQ(a.results.size(), 30U);
  ASSERT_EQ(b.results.size(), 30U);
  for (int i = 0; i < 30; ++i) {
    EXPECT_TRUE(SameBytes(a.results[i].pose.map_from_base, b.results[i].pose.map_from_base)) << i;
    EXPECT_EQ(a.results[i].pose.covariance, b.results[i].pose.covariance) << i;
    EXPECT_EQ(a.results[i].match.e, b.results[i].match.e) << i;
  }
  TestDrive other;
  other.seed = 6;
  PipelineRun c;
  c.Drive(other, 30);
  EXPECT_FALSE(SameBytes(a.results.back().pose.map_from_base, c.results.back().pose.map_from_base));
}

TEST(SlamPipeline, NoResultLeavesTheWindow) {
  // Encoders that are wrong by half, and a window for a tenth.
  TestDrive drive;
  drive.velocity = {1.2, 0.0, 0.0};
  drive.encoder_scale = 0.5;
  for (const Reference reference : {Reference::kLocalMap, Reference::kPreviousFrame}) {
    SlamOptions options;
    options.bounded_icp.reference = reference;
    options.bounded_icp.prediction.bounds.distance_per_time = 0.0;
    options.bounded_icp.prediction.bounds.angle_per_time = 0.2;
    PipelineRun run(options);
    run.Drive(drive, 15);
    ASSERT_EQ(run.results.size(), 15U);
    int on_edge = 0;
    for (const PipelineResult& result : run.results) {
      EXPECT_TRUE(result.match.window.Contains(result.match.deviation));
      on_edge += result.match.status == MatchStatus::kOnWindowEdge;
    }
    EXPECT_GT(on_edge, 7);  // that is, mostly
  }
}

TEST(SlamPipeline, AResetOfTheEncodersIsNoMotion) {
  const TestDrive drive;
  PipelineRun run;
  TestRandom random(drive.seed);
  for (int i = 0; i < 60; ++i) {
    for (int k = i == 0 ? 0 : -4; k <= 0; ++k) {
      const double seconds = 0.1 * i + 0.02 * k;
      const Stamp stamp = kRunStart + FromSeconds(seconds);
      const Pose2 odom =
          i < 30 ? drive.OdomAt(seconds) : drive.OdomAt(2.98).Inverse() * drive.OdomAt(seconds);
      run.pipeline.AddOdometry(stamp, odom, stamp);
    }
    run.Add(drive.ScanAt(0.1 * i, &random));
  }
  run.pipeline.Finish();
  ASSERT_EQ(run.results.size(), 60U);
  const PoseError largest = LargestError(run.results, drive);
  EXPECT_LT(largest.distance, kMaxDistance);
  EXPECT_LT(largest.angle, kMaxAngle);
  // The transform jumps with the encoders, the pose does not.
  const PipelineResult& last = run.results.back();
  ExpectPoseNear(*last.pose.map_from_odom * *last.match.odom_from_base, last.pose.map_from_base);
}

TEST(SlamPipeline, GoesOnWhenTheEncodersFallSilent) {
  TestDrive drive;
  PipelineRun run;
  TestRandom random(drive.seed);
  for (int i = 0; i < 50; ++i) {
    const double seconds = 0.1 * i;
    const Stamp stamp = kRunStart + FromSeconds(seconds);
    if (i < 20) run.pipeline.AddOdometry(stamp, drive.OdomAt(seconds), stamp);
    run.Add(drive.ScanAt(seconds, &random));
  }
  run.pipeline.Finish();
  ASSERT_EQ(run.results.size(), 50U);
  EXPECT_EQ(run.results[10].match.mode, MatchMode::kNoCamera);
  EXPECT_EQ(run.results[40].match.mode, MatchMode::kLaserOnly);
  const PoseError largest = LargestError(run.results, drive);
  EXPECT_LT(largest.distance, kMaxDistance);
  EXPECT_LT(largest.angle, kMaxAngle);
}

TEST(SlamPipeline, CoastsWhileTheLaserIsOut) {
  // Two seconds without a scan: the encoders carry the pose to within their slip of 4 cm, and the
  // next scan says where it is.
  const TestDrive drive;
  PipelineRun run;
  ForEachScan(drive, 50, &run.pipeline, [&](double seconds, const LaserScan& scan) {
    if (seconds < 1.95 || seconds > 3.95) run.Add(scan);
  });
  run.pipeline.Finish();
  ASSERT_EQ(run.results.size(), 30U);
  const PoseError largest = LargestError(run.results, drive);
  EXPECT_LT(largest.distance, kMaxDistance);
  EXPECT_LT(largest.angle, kMaxAngle);
}

}  // namespace
}  // namespace scan_image_slam
