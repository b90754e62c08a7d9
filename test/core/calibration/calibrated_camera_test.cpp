#include "scan_image_slam/core/calibration/calibrated_camera.h"

#include "support_fusion.h"

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

TEST(CameraPose, TellsThePlaceAndTheAngles) {
  CameraView view;
  view.centre = {0.1, -0.2, 0.5};
  view.yaw = 2.0;
  view.pitch = 0.2;
  view.roll = -0.4;
  const SensorPose pose = CameraPose(view.FromOptical());
  EXPECT_FALSE(pose.from_tf);
  EXPECT_NEAR(pose.x, 0.1, 1e-12);
  EXPECT_NEAR(pose.y, -0.2, 1e-12);
  EXPECT_NEAR(pose.z, 0.5, 1e-12);
  EXPECT_NEAR(pose.yaw, 2.0, 1e-12);
  EXPECT_NEAR(pose.pitch, 0.2, 1e-12);
  EXPECT_NEAR(pose.roll, -0.4, 1e-12);
}

TEST(Corrected, TurnsAndMovesTheCameraInTheBase) {
  CameraView view;
  view.centre = {0.1, 0.0, 0.5};
  view.pitch = 0.1;
  view.roll = 0.05;
  CalibrationVector correction{};
  correction[kYaw] = 0.3;
  correction[kForward] = 0.02;
  correction[kLeft] = -0.03;
  const Eigen::Isometry3d corrected = Corrected(view.FromOptical(), correction);
  view.yaw += 0.3;
  view.centre += Eigen::Vector3d(0.02, -0.03, 0.0);
  EXPECT_TRUE(corrected.isApprox(view.FromOptical(), 1e-12));
}

TEST(Corrected, TiltsAboutTheAxesOfTheBase) {
  CalibrationVector roll{};
  roll[kTiltX] = 0.1;
  CalibrationVector pitch{};
  pitch[kTiltY] = 0.1;
  const Eigen::Isometry3d level = CameraView().FromOptical();
  EXPECT_NEAR(CameraPose(Corrected(level, roll)).roll, 0.1, 1e-12);
  EXPECT_NEAR(CameraPose(Corrected(level, pitch)).pitch, 0.1, 1e-12);
  EXPECT_NEAR(CameraPose(Corrected(level, pitch)).roll, 0.0, 1e-12);
}

TEST(RowOfLaserPlane, IsWhereThePlaneIsSeenAhead) {
  CameraView view;
  view.centre = {0.1, 0.0, 0.5};
  view.yaw = 0.7;
  const CameraModel camera(PinholeCamera());  // focal length 300, middle row 119.5
  // 0.2 m below at 3 m: 20 rows below the middle.
  EXPECT_NEAR(RowOfLaserPlane(camera, view.FromOptical(), 0.3, 3.0), 139.5, 1e-3);
  view.pitch = std::atan2(0.2, 3.0);
  EXPECT_NEAR(RowOfLaserPlane(camera, view.FromOptical(), 0.3, 3.0), 119.5, 1e-3);
  view.pitch = 1.0;
  EXPECT_TRUE(std::isnan(RowOfLaserPlane(camera, view.FromOptical(), 0.3, 3.0)));
}

}  // namespace
}  // namespace scan_image_slam
