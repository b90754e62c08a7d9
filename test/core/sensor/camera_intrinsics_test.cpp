#include "scan_image_slam/core/sensor/camera_model.h"

#include <limits>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

CameraIntrinsics Good() {
  CameraIntrinsics intrinsics;
  intrinsics.width = 640;
  intrinsics.height = 480;
  intrinsics.k = cv::Matx33d(500, 0, 320, 0, 500, 240, 0, 0, 1);
  return intrinsics;
}

void ExpectRefused(const CameraIntrinsics& intrinsics, const std::string& because) {
  try {
    intrinsics.Validate();
    ADD_FAILURE() << "accepted, but " << because;
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find(because), std::string::npos) << error.what();
  }
}

bool Accepts(const std::string& model, std::size_t coefficients) {
  CameraIntrinsics intrinsics = Good();
  intrinsics.distortion_model = model;
  intrinsics.d.assign(coefficients, 0.001);
  try {
    intrinsics.Validate();
    return true;
  } catch (const std::invalid_argument&) {
    return false;
  }
}

TEST(CameraIntrinsics, WithoutASizeItIsRefused) {
  CameraIntrinsics intrinsics = Good();
  intrinsics.width = 0;
  ExpectRefused(intrinsics, "image size 0 x 480");
  intrinsics = Good();
  intrinsics.height = -1;
  ExpectRefused(intrinsics, "image size 640 x -1");
}

TEST(CameraIntrinsics, AnUncalibratedCameraIsRefused) {
  ExpectRefused(
      [] {
        CameraIntrinsics intrinsics = Good();
        intrinsics.k = cv::Matx33d::zeros();
        return intrinsics;
      }(),
      "not calibrated");
  for (const int diagonal : {0, 1}) {
    CameraIntrinsics intrinsics = Good();
    intrinsics.k(diagonal, diagonal) = -500.0;
    ExpectRefused(intrinsics, "not calibrated");
  }
}

TEST(CameraIntrinsics, NumbersThatAreNotFiniteAreRefused) {
  CameraIntrinsics intrinsics = Good();
  intrinsics.k(0, 2) = std::numeric_limits<double>::quiet_NaN();
  ExpectRefused(intrinsics, "K holds");
  intrinsics = Good();
  intrinsics.d = {0.1, 0.0, std::numeric_limits<double>::infinity(), 0.0};
  ExpectRefused(intrinsics, "D holds");
}

TEST(CameraIntrinsics, AnUnknownLensIsRefusedByName) {
  CameraIntrinsics intrinsics = Good();
  intrinsics.distortion_model = "thin_prism";
  ExpectRefused(intrinsics, "'thin_prism'");
}

TEST(CameraIntrinsics, EveryLensHasItsNumbersOfCoefficients) {
  for (const std::size_t n : {0U, 4U, 5U}) EXPECT_TRUE(Accepts("plumb_bob", n)) << n;
  for (const std::size_t n : {1U, 3U, 6U, 8U}) EXPECT_FALSE(Accepts("plumb_bob", n)) << n;
  for (const std::size_t n : {8U, 12U, 14U}) EXPECT_TRUE(Accepts("rational_polynomial", n)) << n;
  for (const std::size_t n : {5U, 7U}) EXPECT_FALSE(Accepts("rational_polynomial", n)) << n;
  EXPECT_TRUE(Accepts("equidistant", 4));
  for (const std::size_t n : {3U, 5U}) EXPECT_FALSE(Accepts("equidistant", n)) << n;
}

TEST(CameraIntrinsics, AWrongNumberOfCoefficientsIsNamed) {
  CameraIntrinsics intrinsics = Good();
  intrinsics.d = {0.1, 0.1, 0.1};
  ExpectRefused(intrinsics, "3 coefficients");
}

TEST(CameraIntrinsics, ACameraIsNotMadeOfWrongOnes) {
  CameraIntrinsics intrinsics = Good();
  intrinsics.width = 0;
  EXPECT_THROW(CameraModel{intrinsics}, std::invalid_argument);
}

TEST(CameraIntrinsics, NoCoefficientsAreNoDistortionForEveryLens) {
  EXPECT_TRUE(Accepts("rational_polynomial", 0));
  EXPECT_TRUE(Accepts("equidistant", 0));
}

}  // namespace
}  // namespace scan_image_slam
