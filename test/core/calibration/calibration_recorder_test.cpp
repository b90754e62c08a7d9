#include "scan_image_slam/core/calibration/calibration_recorder.h"

#include "scan_image_slam/core/calibration/calibration_picture.h"
#include "support_fusion.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace scan_image_slam {
namespace {

/// A dark panel of a post's width stands 2 m before a bright wall; laser and camera at the base.
class Recorder : public ::testing::Test {
 protected:
  Recorder() : fusion_(ScanImageFusionOptions{}), recorder_(CalibrationRecorderOptions{}) {
    PaintedWall& wall = world_.AddWall({4.0, -6.0}, {4.0, 6.0});
    wall.grey = 200.0;
    PaintedWall& post = world_.AddWall({2.0, -0.2}, {2.0, 0.3});
    post.grey = 40.0;
    LaserMount laser;
    laser.height = 0.3;
    fusion_.SetLaser(laser);
    view_.centre = {0.0, 0.0, 0.5};
    fusion_.SetCamera(PinholeCamera(), view_.FromOptical());
  }

  /// A scan and a picture at a time [s] and a place; the world does not move along.
  void Record(double time, const Pose2& pose) {
    LaserScan scan;
    scan.stamp = FromSeconds(time);
    scan.angle_min = -1.0;
    scan.angle_increment = 0.004;
    scan.range_min = 0.1;
    scan.range_max = 30.0;
    for (int i = 0; i <= 500; ++i) {
      scan.ranges.push_back(static_cast<float>(world_.Range({0.0, 0.0}, scan.Bearing(i))));
    }
    const cv::Mat grey = RenderPicture(
        PinholeCamera(), view_.FromOptical(),
        [&](const Eigen::Vector3d& origin, const Eigen::Vector3d& ray) {
          double multiple = 0.0;
          double along = 0.0;
          for (auto wall = world_.walls.rbegin(); wall != world_.walls.rend(); ++wall) {
            if (wall->Meet(origin.head<2>(), ray.head<2>(), &multiple, &along)) return wall->grey;
          }
          return 120.0;
        });
    fusion_.AddImage({scan.stamp, grey, nullptr});
    recorder_.Add(fusion_, fusion_.Fuse(scan), pose);
  }

  PaintedWorld world_;
  CameraView view_;
  ScanImageFusion fusion_;
  CalibrationRecorder recorder_;
};

TEST_F(Recorder, SeesThePostWithBothSensors) {
  Record(1.0, {});
  ASSERT_EQ(recorder_.data().views.size(), 1U);
  const CalibrationView& view = recorder_.data().views[0];
  EXPECT_EQ(view.stamp, FromSeconds(1.0));
  const double right = std::atan2(-0.2, 2.0);
  const double left = std::atan2(0.3, 2.0);
  ASSERT_EQ(view.edges.size(), 2U);
  EXPECT_NEAR(view.edges[0].bearing, right, 0.3 / 300.0);  // of a pixel
  EXPECT_NEAR(view.edges[1].bearing, left, 0.3 / 300.0);
  EXPECT_NEAR(view.edges[0].slope, -0.1, 0.01);  // the laser's plane is 0.2 m below, 2 m ahead
  ASSERT_EQ(view.jumps.size(), 2U);
  const auto bearing = [](const Eigen::Vector2d& p) { return std::atan2(p.y(), p.x()); };
  EXPECT_NEAR(bearing(view.jumps[0].in_base), right, 0.0021);  // half of a beam's step
  EXPECT_NEAR(bearing(view.jumps[1].in_base), left, 0.0021);
  EXPECT_EQ(view.jumps[0].side, -1);
  EXPECT_EQ(view.jumps[1].side, 1);
}

TEST_F(Recorder, TakesNewViewsOnlyFromNewPlacesButEachPose) {
  Record(1.0, {});
  Record(1.1, {0.01, 0.0, 0.002});
  EXPECT_EQ(recorder_.data().views.size(), 1U);
  EXPECT_EQ(recorder_.data().trajectory.size(), 2U);
  Record(1.2, {0.035, 0.0, 0.0});
  EXPECT_EQ(recorder_.data().views.size(), 2U);
  Record(1.3, {0.035, 0.0, 0.011});
  EXPECT_EQ(recorder_.data().views.size(), 3U);
}

TEST_F(Recorder, DrawsTheViewBeforeAndAfter) {
  EXPECT_TRUE(DrawCalibration(recorder_, fusion_, {}).empty());
  Record(1.0, {});
  const cv::Mat same = DrawCalibration(recorder_, fusion_, {});
  ASSERT_EQ(same.size(), cv::Size(320, 480));
  CalibrationVector turned{};
  turned[kYaw] = 0.1;  // 30 pixels: the camera looks farther left, the post is drawn farther right
  const cv::Mat after = DrawCalibration(recorder_, fusion_, turned);
  const auto white = [](const cv::Mat& picture, int column) {
    cv::Mat bars;
    cv::inRange(picture.col(column), cv::Scalar::all(225), cv::Scalar::all(255), bars);
    return cv::countNonZero(bars) > 20;
  };
  // A bar of 0.5 m is 75 rows at 2 m.
  const auto has_bar = [&](const cv::Mat& picture, double column) {
    for (int c = static_cast<int>(column) - 2; c <= static_cast<int>(column) + 2; ++c) {
      if (white(picture, c)) return true;
    }
    return false;
  };
  const double left = 159.5 - 300.0 * 0.15;
  EXPECT_TRUE(has_bar(same.rowRange(0, 240), left));
  EXPECT_TRUE(has_bar(same.rowRange(240, 480), left));
  EXPECT_TRUE(has_bar(after.rowRange(0, 240), left));
  EXPECT_FALSE(has_bar(after.rowRange(240, 480), left));
  const double moved = 159.5 - 300.0 * std::tan(std::atan2(0.3, 2.0) - 0.1);
  EXPECT_TRUE(has_bar(after.rowRange(240, 480), moved));
}

}  // namespace
}  // namespace scan_image_slam
