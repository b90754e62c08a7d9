#include "scan_image_slam/core/fusion/scan_image_fusion.h"
#include "support_fusion.h"
#include "support_rooms.h"

#include <stdexcept>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

constexpr Stamp kStart = 1'000'000'000;

CameraImage Image(double seconds, int width = 320, int height = 240) {
  return {kStart + FromSeconds(seconds), cv::Mat(height, width, CV_8U, cv::Scalar(90)), nullptr};
}

LaserScan Scan(double seconds) {
  return ScanOf(FurnishedRoom(), Pose2(), kStart + FromSeconds(seconds), TestLaser());
}

void SetCamera(ScanImageFusion* fusion) {
  fusion->SetCamera(PinholeCamera(320, 240), CameraView{{0, 0, 1.0}}.FromOptical());
}

TEST(WaitingImage, IsUsedOnceTheCameraIsKnown) {
  ScanImageFusion fusion{ScanImageFusionOptions()};
  fusion.AddImage(Image(0.0));
  EXPECT_FALSE(fusion.Fuse(Scan(0.01)).has_image) << "nothing says how the camera sees";
  SetCamera(&fusion);
  EXPECT_TRUE(fusion.Fuse(Scan(0.035)).has_image);
  EXPECT_FALSE(fusion.Fuse(Scan(0.060)).has_image) << "an image is used once";
}

TEST(WaitingImage, IsTooOldWhenTheCameraComesLate) {
  ScanImageFusion fusion{ScanImageFusionOptions()};
  fusion.AddImage(Image(0.0));
  SetCamera(&fusion);
  EXPECT_FALSE(fusion.Fuse(Scan(0.2)).has_image) << "max_image_age is 0.1 s";
}

TEST(WaitingImage, OfAnotherSizeDoesNotKeepTheCameraAway) {
  ScanImageFusion fusion{ScanImageFusionOptions()};
  fusion.AddImage(Image(0.0, 160, 120));
  ASSERT_NO_THROW(SetCamera(&fusion));
  EXPECT_FALSE(fusion.Fuse(Scan(0.01)).has_image);
  EXPECT_THROW(fusion.AddImage(Image(0.02, 160, 120)), std::invalid_argument);
  fusion.AddImage(Image(0.03));
  EXPECT_TRUE(fusion.Fuse(Scan(0.035)).has_image);
}

TEST(RemoveCamera, LeavesTheLaserAlone) {
  ScanImageFusion fusion{ScanImageFusionOptions()};
  SetCamera(&fusion);
  fusion.AddImage(Image(0.0));
  fusion.RemoveCamera();
  EXPECT_FALSE(fusion.has_camera());
  const FusedModel model = fusion.Fuse(Scan(0.01));
  EXPECT_FALSE(model.has_image);
  EXPECT_EQ(model.beams.size(), 720u);
}

}  // namespace
}  // namespace scan_image_slam
