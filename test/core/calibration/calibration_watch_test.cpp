#include "scan_image_slam/core/calibration/calibration_watch.h"

#include "support_fusion.h"

#include <cmath>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace scan_image_slam {
namespace {

constexpr Stamp kStart = 1700000000LL * 1000000000LL;

/// Panels at odd places before the walls of a room: their ends are edges for both sensors.
PaintedWorld RoomWithPanels(double panel_grey, int panels = 8) {
  const double size = 8.0 / panels;
  PaintedWorld world;
  world.floor_height = -100.0;
  world.AddWall({5.0, -5.0}, {5.0, 5.0});
  world.AddWall({5.0, 5.0}, {-5.0, 5.0});
  world.AddWall({-5.0, 5.0}, {-5.0, -5.0});
  world.AddWall({-5.0, -5.0}, {5.0, -5.0});
  double bearing = -1.9;
  for (int i = 0; i < panels; ++i) {
    const double distance = 2.0 + 0.25 * (i % 5);
    const Eigen::Vector2d middle = distance * Eigen::Vector2d(std::cos(bearing), std::sin(bearing));
    const Eigen::Vector2d half = size * 0.06 * (2 + i % 3) * Across(middle.normalized());
    world.AddWall(middle - half, middle + half).grey = panel_grey;
    bearing += size * (0.4 + 0.07 * (i % 4));
  }
  return world;
}

/// Stripes on the walls, where the laser feels nothing.
void PaintWalls(PaintedWorld* world) {
  for (int w = 0; w < 4; ++w) {
    for (double at = 0.3; at < 9.5; at += 0.61 + 0.13 * w) {
      world->walls[w].paints.push_back({at, at + 0.21, -1e3, 1e3, 70.0});
    }
  }
}

/// A robot that drives, with a camera that may be other than the fusion believes.
struct Drive {
  PaintedWorld world = RoomWithPanels(60.0);
  PaintedWorld seen = world;  ///< by the camera
  double yaw = 0.0;           ///< of the camera, to the left [rad]
  double late_yaw = 0.0;      ///< its yaw in the second half of the time, if not as before [rad]
  double time_offset = 0.0;   ///< by which pictures are taken after their stamps [s]
  double turns = 1.0;         ///< how far the robot turns to and fro [rad]
  double way = 0.3;           ///< and drives ahead and back [m]
  double seconds = 40.0;

  Pose2 PoseAt(double t) const {
    return {way * std::sin(0.31 * t), 0.5 * way * std::sin(0.17 * t), turns * std::sin(0.5 * t)};
  }

  std::optional<CameraMisfit> Misfit() const {
    constexpr double kScanPeriod = 0.1;
    constexpr double kImageLead = 0.02;  // the picture is stamped before the scan [s]
    ScanImageFusion fusion{ScanImageFusionOptions()};
    LaserMount laser;
    laser.height = 0.5;
    fusion.SetLaser(laser);
    CameraView camera;
    camera.centre = {0.1, 0.0, 0.5};
    fusion.SetCamera(PinholeCamera(), camera.FromOptical());
    CalibrationWatch watch;
    for (double t = 0.0; t < seconds; t += kScanPeriod) {
      for (double at = t; at < t + kScanPeriod - 0.01; at += 0.02) {
        fusion.AddOdometry(kStart + FromSeconds(at), PoseAt(at));
      }
      camera.yaw = late_yaw != 0.0 && t > 0.5 * seconds ? late_yaw : yaw;
      const double taken = t - kImageLead + time_offset;
      fusion.AddImage({kStart + FromSeconds(t - kImageLead), PictureAt(taken, camera), nullptr});
      watch.Add(fusion, fusion.Fuse(ScanAt(t)));
    }
    return watch.Misfit();
  }

 private:
  /// Half of the period goes by while the laser turns.
  LaserScan ScanAt(double t) const {
    constexpr int kBeams = 801;
    LaserScan scan;
    scan.stamp = kStart + FromSeconds(t);
    scan.angle_min = -2.0;
    scan.angle_increment = 0.005;
    scan.time_increment = 0.05 / kBeams;
    scan.range_min = 0.1;
    scan.range_max = 30.0;
    for (int i = 0; i < kBeams; ++i) {
      const Pose2 fired = PoseAt(t + i * scan.time_increment);
      const double heading = fired.theta + scan.Bearing(i);
      scan.ranges.push_back(static_cast<float>(world.Range(fired.translation(), heading)));
    }
    return scan;
  }
  /// Nothing in this world depends on height: one row is enough to know the picture.
  cv::Mat PictureAt(double t, const CameraView& camera) const {
    const cv::Mat row = seen.Picture(PinholeCamera(320, 1), Lift(PoseAt(t)) * camera.FromOptical());
    return cv::repeat(row, 240, 1);
  }
};

TEST(CalibrationWatch, FindsNothingWrongWithACameraThatFits) {
  const std::optional<CameraMisfit> misfit = Drive().Misfit();
  ASSERT_TRUE(misfit);
  EXPECT_NEAR(misfit->yaw, 0.0, 0.05 * kDegree);
  EXPECT_NEAR(misfit->time_offset, 0.0, 0.002);
}

TEST(CalibrationWatch, TellsTheYawOfTheCamera) {
  for (const double yaw : {-3.0 * kDegree, 1.0 * kDegree}) {
    Drive drive;
    drive.yaw = yaw;
    const std::optional<CameraMisfit> misfit = drive.Misfit();
    ASSERT_TRUE(misfit) << yaw;
    EXPECT_NEAR(misfit->yaw, yaw, 0.1 * kDegree);
    EXPECT_NEAR(misfit->time_offset, 0.0, 0.003);
    EXPECT_LT(misfit->yaw_stddev, 0.1 * kDegree);
  }
}

TEST(CalibrationWatch, TellsPicturesThatAreTakenAtAnotherTime) {
  for (const double time : {-0.06, 0.03}) {
    Drive drive;
    drive.time_offset = time;
    const std::optional<CameraMisfit> misfit = drive.Misfit();
    ASSERT_TRUE(misfit) << time;
    EXPECT_NEAR(misfit->time_offset, time, 0.003);
    EXPECT_NEAR(misfit->yaw, 0.0, 0.1 * kDegree);
    EXPECT_LT(misfit->time_offset_stddev, 0.003);
  }
}

TEST(CalibrationWatch, IsNotSureOfTheTimeIfTheRobotDoesNotTurn) {
  Drive drive;
  drive.turns = 0.0;
  drive.way = 0.6;
  drive.seconds = 100.0;
  drive.yaw = 1.0 * kDegree;
  const std::optional<CameraMisfit> misfit = drive.Misfit();
  ASSERT_TRUE(misfit);
  EXPECT_NEAR(misfit->yaw, drive.yaw, 0.1 * kDegree);
  EXPECT_GT(misfit->time_offset_stddev, 0.005);
}

TEST(CalibrationWatch, FindsTheObjectsAmongPaint) {
  Drive drive;
  PaintWalls(&drive.seen);
  drive.yaw = -1.0 * kDegree;
  drive.time_offset = 0.03;
  const std::optional<CameraMisfit> misfit = drive.Misfit();
  ASSERT_TRUE(misfit);
  EXPECT_NEAR(misfit->yaw, drive.yaw, 0.2 * kDegree);
  EXPECT_NEAR(misfit->time_offset, drive.time_offset, 0.005);
}

TEST(CalibrationWatch, SaysNothingIfTheEdgesDoNotBelongToTheObjects) {
  Drive drive;
  drive.seen.walls.resize(4);  // without the panels, and what they hide
  PaintWalls(&drive.seen);
  EXPECT_FALSE(drive.Misfit());
}

TEST(CalibrationWatch, ForgetsHowTheCameraWas) {
  Drive drive;
  drive.late_yaw = 2.0 * kDegree;
  drive.seconds = 160.0;
  const std::optional<CameraMisfit> misfit = drive.Misfit();
  ASSERT_TRUE(misfit);
  EXPECT_NEAR(misfit->yaw, 2.0 * kDegree, 0.1 * kDegree);
}

TEST(CalibrationWatch, IsInDoubtIfTheCameraWasMovedALittle) {
  Drive drive;
  drive.late_yaw = 0.2 * kDegree;
  const std::optional<CameraMisfit> misfit = drive.Misfit();
  ASSERT_TRUE(misfit);
  EXPECT_GT(misfit->yaw_stddev, 0.08 * kDegree);
}

TEST(CalibrationWatch, SaysNothingIfItSeesLittle) {
  Drive drive;
  drive.world = drive.seen = RoomWithPanels(60.0, 2);
  drive.seconds = 15.0;
  EXPECT_FALSE(drive.Misfit());
}

TEST(CalibrationWatch, SaysNothingOfAFewViewsHoweverMuchTheyShow) {
  Drive drive;
  PaintWalls(&drive.seen);
  drive.seconds = 8.0;
  EXPECT_FALSE(drive.Misfit());
  drive.seconds = 16.0;
  EXPECT_TRUE(drive.Misfit());
}

TEST(CalibrationWatch, KeepsEnoughViewsHoweverMuchTheyShow) {
  Drive drive;
  drive.world = drive.seen = RoomWithPanels(60.0, 40);
  drive.time_offset = 0.03;
  const std::optional<CameraMisfit> misfit = drive.Misfit();
  ASSERT_TRUE(misfit);
  EXPECT_NEAR(misfit->time_offset, drive.time_offset, 0.005);
}

TEST(CalibrationWatch, SaysNothingWhileItStands) {
  Drive drive;
  drive.turns = 0.0;
  drive.way = 0.0;
  EXPECT_FALSE(drive.Misfit());
}

}  // namespace
}  // namespace scan_image_slam
