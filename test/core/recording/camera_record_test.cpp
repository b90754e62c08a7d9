#include "scan_image_slam/core/recording/camera_record.h"

#include "core/recording/findings.h"

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

CameraIntrinsics GoodCamera() {
  CameraIntrinsics camera;
  camera.width = 640;
  camera.height = 480;
  camera.k = cv::Matx33d(320, 0, 320, 0, 320, 240, 0, 0, 1);  // 90 degrees wide
  camera.d = {-0.2, 0.05, 0.0, 0.0, 0.0};
  return camera;
}

ImageRecord Images(int width = 640, int height = 480, double brightness = 100.0) {
  ImageRecord images;
  images.Add(width, height, "mono8", brightness);
  return images;
}

Findings Check(const CameraIntrinsics& camera, const ImageRecord& images = Images()) {
  return CheckCalibration("/camera_info", {camera, ""}, images);
}

TEST(ImageRecord, SizeIsThatOfMostAndBrightnessTheMean) {
  ImageRecord images = Images(640, 480, 60.0);
  images.Add(320, 240, "mono8", 90.0);
  images.Add(640, 480, "mono8", 120.0);
  EXPECT_EQ(images.Size(), std::make_pair(640, 480));
  EXPECT_TRUE(images.SizeChanges());
  EXPECT_DOUBLE_EQ(images.Brightness(), 90.0);
  EXPECT_EQ(DescribeImages(images), "640x480 px, mono8, mean grey level 90");
  EXPECT_TRUE(Tells(CheckImages("/image", images), "more than one size"));
}

TEST(CheckImages, GoodOnesGiveNothing) { EXPECT_TRUE(CheckImages("/image", Images()).empty()); }

TEST(CheckImages, DarkAndBright) {
  EXPECT_TRUE(Tells(CheckImages("/image", Images(640, 480, 12.0)), "very dark"));
  EXPECT_TRUE(Tells(CheckImages("/image", Images(640, 480, 250.0)), "very bright"));
}

TEST(CheckImages, UnreadableOnesAreAnErrorIfAllAre) {
  ImageRecord images;
  images.AddUnreadable("encoding 'h264'");
  images.AddUnreadable("another reason");
  const Finding all = FindingWith(CheckImages("/image", images), "2 of 2 can't be read");
  EXPECT_EQ(all.severity, Severity::kError);
  EXPECT_NE(all.text.find("encoding 'h264'"), std::string::npos);
  images.Add(640, 480, "mono8", 100.0);
  EXPECT_EQ(FindingWith(CheckImages("/image", images), "2 of 3 can't be read").severity,
            Severity::kWarning);
}

TEST(CheckImages, AMosaicThatIsLabelledGrey) {
  ImageRecord images = Images();
  images.AddBayer();
  EXPECT_EQ(FindingWith(CheckImages("/image", images), "mosaic").severity, Severity::kNote);
}

TEST(CheckCalibration, AGoodOneGivesNothing) {
  EXPECT_TRUE(Check(GoodCamera()).empty());
  EXPECT_EQ(DescribeCalibration(GoodCamera()), "640x480 px, 90 deg wide, plumb_bob");
}

TEST(CheckCalibration, AMissingOneIsAnError) {
  const Finding finding =
      FindingWith(CheckCalibration("/camera_info", {std::nullopt, "K[0] is 0"}, Images()), "K[0]");
  EXPECT_EQ(finding.severity, Severity::kError);
}

TEST(CheckCalibration, AnotherSizeIsAnError) {
  const Finding finding = FindingWith(Check(GoodCamera(), Images(1280, 960)), "640x480 px");
  EXPECT_EQ(finding.severity, Severity::kError);
  EXPECT_NE(finding.text.find("1280x960 px"), std::string::npos);
}

TEST(CheckCalibration, WhatNoLensHas) {
  CameraIntrinsics camera = GoodCamera();
  camera.k(0, 2) = 100.0;
  EXPECT_TRUE(Tells(Check(camera), "far from the middle"));
  camera = GoodCamera();
  camera.k(0, 0) = camera.k(1, 1) = 5000.0;  // 2 atan(320 / 5000) = 7 degrees
  EXPECT_TRUE(Tells(Check(camera), "would see 7 deg"));
  camera = GoodCamera();
  camera.k(1, 1) = 200.0;
  EXPECT_TRUE(Tells(Check(camera), "square"));
  camera = GoodCamera();
  camera.k(0, 0) = 200.0;
  EXPECT_TRUE(Tells(Check(camera), "square"));
}

TEST(CheckCalibration, NoDistortionIsANote) {
  CameraIntrinsics camera = GoodCamera();
  camera.d.clear();
  EXPECT_EQ(FindingWith(Check(camera), "no lens distortion").severity, Severity::kNote);
  camera.d.assign(5, 0.0);
  EXPECT_TRUE(Tells(Check(camera), "no lens distortion"));
}

}  // namespace
}  // namespace scan_image_slam
