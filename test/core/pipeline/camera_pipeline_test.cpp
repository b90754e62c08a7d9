// What the camera adds: a corridor that looks the same to the laser all along.
#include "pipeline_fixtures.h"
#include "support_fusion.h"

#include <memory>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

constexpr double kWay = 1.5;     // driven [m]
constexpr int kScans = 26;       // at 10 Hz
constexpr double kScale = 1.08;  // of the encoders: 12 cm too far at the end

/// Two walls along x, 2 m apart, with dark doors of irregular widths and distances.
PaintedWorld Corridor() {
  PaintedWorld world;
  world.floor_height = 0.0;
  TestRandom random(4);
  for (const double side : {-1.0, 1.0}) {
    PaintedWall& wall = world.AddWall({-40.0, side}, {40.0, side});
    for (double x = 0.5; x < 79.0; x += random.Uniform(0.8, 1.4)) {
      wall.paints.push_back({x, x + random.Uniform(0.25, 0.5), 0.0, 2.0, 60.0});
    }
  }
  return world;
}

double XAt(int scan) { return kWay * scan / (kScans - 1); }

/// The error along the corridor at its end [m].
double ErrorAlong(bool images) {
  const PaintedWorld world = Corridor();
  const CameraIntrinsics camera = PinholeCamera(160, 120, 100.0);
  CameraView view;
  view.centre = {0.0, 0.0, 0.5};
  PipelineRun run;
  LaserMount laser;
  laser.height = 0.4;
  run.pipeline.fusion().SetLaser(laser);
  run.pipeline.fusion().SetCamera(camera, view.FromOptical());
  for (int i = 0; i < kScans; ++i) {
    const Stamp stamp = kRunStart + FromSeconds(0.1 * i);
    const Pose2 world_from_base{XAt(i), 0.0, 0.0};
    run.pipeline.AddOdometry(stamp, {kScale * XAt(i), 0.0, 0.0}, stamp);
    if (images) {
      const cv::Mat grey = world.Picture(camera, Lift(world_from_base) * view.FromOptical());
      run.pipeline.AddImage({stamp, grey, nullptr}, stamp);
    }
    LaserScan scan = world.Scan(world_from_base, -M_PI, 2.0 * M_PI / 720, 720);
    scan.stamp = stamp;
    scan.range_max = 10.0;
    run.Add(scan);
  }
  run.pipeline.Finish();
  EXPECT_EQ(run.results.size(), static_cast<std::size_t>(kScans));
  for (const PipelineResult& result : run.results) {
    EXPECT_EQ(result.model.has_image, images);
    EXPECT_NEAR(result.pose.map_from_base.y, 0.0, 0.01);
  }
  return run.results.back().pose.map_from_base.x - kWay;
}

TEST(CameraPipeline, WithoutImagesTheCorridorIsAsLongAsTheEncodersSay) {
  EXPECT_NEAR(ErrorAlong(false), (kScale - 1.0) * kWay, 0.01);
}

TEST(CameraPipeline, WithImagesItIsAsLongAsItIs) {
  // A fifth of what the encoders are wrong by.
  EXPECT_NEAR(ErrorAlong(true), 0.0, 0.2 * (kScale - 1.0) * kWay);
}

TEST(CameraPipeline, TheModeTellsWhatAPoseRestsOn) {
  const PaintedWorld world = Corridor();
  for (const bool encoders : {true, false}) {
    PipelineRun run;
    run.pipeline.fusion().SetCamera(PinholeCamera(160, 120, 100.0), CameraView().FromOptical());
    for (int i = 0; i < 4; ++i) {
      const Stamp stamp = kRunStart + FromSeconds(0.1 * i);
      if (encoders) run.pipeline.AddOdometry(stamp, {}, stamp);
      if (i < 2) {
        run.pipeline.AddImage({stamp, cv::Mat(120, 160, CV_8U, cv::Scalar(90)), nullptr}, stamp);
      }
      LaserScan scan = world.Scan({}, -M_PI, 2.0 * M_PI / 360, 360);
      scan.stamp = stamp;
      if (i == 3) scan.ranges.clear();
      run.Add(scan);
    }
    run.pipeline.Finish();
    ASSERT_EQ(run.results.size(), 4U);
    EXPECT_EQ(run.results[1].match.mode, encoders ? MatchMode::kFull : MatchMode::kNoEncoders);
    EXPECT_EQ(run.results[3].match.mode, MatchMode::kCoasting);
  }
}

TEST(CameraPipeline, AnImageOfAnotherSizeIsRefusedWithBothSizes) {
  PipelineRun run;
  run.pipeline.fusion().SetCamera(PinholeCamera(160, 120, 100.0), CameraView().FromOptical());
  try {
    run.pipeline.AddImage({kRunStart, cv::Mat(60, 80, CV_8U, cv::Scalar(0)), nullptr}, kRunStart);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("80 x 60"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("160 x 120"), std::string::npos);
  }
}

TEST(CameraPipeline, AnImageThatIsTooOldIsNotUsed) {
  const PaintedWorld world = Corridor();
  const CameraIntrinsics camera = PinholeCamera(160, 120, 100.0);
  PipelineRun run;
  run.pipeline.fusion().SetCamera(camera, CameraView().FromOptical());
  const cv::Mat grey(120, 160, CV_8U, cv::Scalar(90));
  const double ages[] = {0.099, 0.101, -0.099, -0.101};  // the default limit is 0.1 s
  for (int i = 0; i < 4; ++i) {
    LaserScan scan = world.Scan({}, -M_PI, 2.0 * M_PI / 360, 360);
    scan.stamp = kRunStart + FromSeconds(i);
    run.pipeline.AddImage({scan.stamp - FromSeconds(ages[i]), grey, nullptr}, scan.stamp);
    run.Add(scan);
    run.pipeline.Finish();
  }
  ASSERT_EQ(run.results.size(), 4U);
  EXPECT_TRUE(run.results[0].model.has_image);
  EXPECT_FALSE(run.results[1].model.has_image);
  EXPECT_TRUE(run.results[2].model.has_image);
  EXPECT_FALSE(run.results[3].model.has_image);
}

}  // namespace
}  // namespace scan_image_slam
