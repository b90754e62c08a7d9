#include "scan_image_slam/core/calibration/calibration_solver.h"

#include "posts_drive.h"

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

constexpr double kDegree = M_PI / 180.0;

/// What a calibration must reach.
constexpr double kYawTolerance = 0.1 * kDegree;
constexpr double kPlaceTolerance = 0.005;  // [m]
constexpr double kTimeTolerance = 0.002;   // [s]

CalibrationResult CalibrationOf(const PostsDrive& drive) {
  CalibrationSolverOptions options;
  options.search_views = 120;
  return Calibrate(drive.Record(), options);
}

void ExpectTruth(const PostsDrive& drive, const CalibrationResult& result) {
  ASSERT_EQ(result.refusal, "");
  for (const CalibrationQuantity& quantity : result.quantities) EXPECT_EQ(quantity.refusal, "");
  EXPECT_NEAR(result.quantities[kYaw].correction, drive.yaw, kYawTolerance);
  EXPECT_NEAR(result.quantities[kForward].correction, drive.forward, kPlaceTolerance);
  EXPECT_NEAR(result.quantities[kLeft].correction, drive.left, kPlaceTolerance);
  EXPECT_NEAR(result.quantities[kTime].correction, drive.time, kTimeTolerance);
}

class WrongStart : public ::testing::TestWithParam<int> {};

TEST_P(WrongStart, IsCorrected) {
  // 3 degrees, 5 cm and 30 ms, with different signs.
  const auto sign = [&](int bit) { return (GetParam() >> bit & 1) != 0 ? 1.0 : -1.0; };
  PostsDrive drive;
  drive.yaw = 3.0 * kDegree * sign(0);
  drive.forward = 0.05 * sign(1);
  drive.left = 0.05 * sign(2);
  drive.time = 0.03 * sign(0) * sign(1);
  drive.seed = 10 + GetParam();
  const CalibrationResult result = CalibrationOf(drive);
  ExpectTruth(drive, result);
  // 3 degrees are 21.8 of these pixels; the noise of a bearing is 0.42.
  EXPECT_GT(result.rms_before, 10.0);
  EXPECT_LT(result.rms_after, 1.0);
}
INSTANTIATE_TEST_SUITE_P(Signs, WrongStart, ::testing::Range(0, 8));

TEST(Calibrate, LeavesWhatIsRight) {
  const PostsDrive drive;
  const CalibrationResult result = CalibrationOf(drive);
  ExpectTruth(drive, result);
  EXPECT_LT(result.rms_before, 1.0);
  EXPECT_GT(result.views, 250);
}

TEST(Calibrate, FindsTheTiltByTheLeanOfEdges) {
  PostsDrive drive;
  drive.yaw = 0.02;
  drive.tilt_x = 0.03;
  drive.tilt_y = -0.02;
  const CalibrationResult result = CalibrationOf(drive);
  ExpectTruth(drive, result);
  EXPECT_NEAR(result.quantities[kTiltX].correction, 0.03, 0.001);
  EXPECT_NEAR(result.quantities[kTiltY].correction, -0.02, 0.001);
}

TEST(Calibrate, IsNotMovedByTheWidthOfTheSpot) {
  PostsDrive drive;
  drive.border = 0.002;
  const CalibrationResult result = CalibrationOf(drive);
  ExpectTruth(drive, result);
  EXPECT_NEAR(result.quantities[kBorder].correction, 0.002, 0.0003);
}

TEST(Calibrate, SaysHowSureItIs) {
  // Normalised squared errors over independent drives: 1 on average.
  constexpr int kDrives = 12;
  std::array<double, 4> sums{};
  for (int i = 0; i < kDrives; ++i) {
    PostsDrive drive;
    drive.seed = 100 + i;
    drive.seconds = 15.0;
    const CalibrationResult result = CalibrationOf(drive);
    ASSERT_EQ(result.refusal, "");
    for (int k = 0; k < 4; ++k) {
      sums[k] += std::pow(result.quantities[k].correction / result.quantities[k].stddev, 2);
    }
  }
  // Chi square of 12 degrees of freedom, 0.1 % and 99.9 %; too careful by a factor of two at most.
  for (const double sum : sums) {
    EXPECT_GT(sum, 2.2 / 4.0);
    EXPECT_LT(sum, 32.9);
  }
}

TEST(Calibrate, KeepsTheDelayOnAStraightDrive) {
  PostsDrive drive;
  drive.turn_rate = 0.0;
  drive.time = 0.03;
  drive.yaw = 0.03;
  const CalibrationResult result = CalibrationOf(drive);
  ASSERT_EQ(result.refusal, "");
  EXPECT_NE(result.quantities[kTime].refusal.find("turned too little"), std::string::npos);
  EXPECT_EQ(result.quantities[kTime].correction, 0.0);
  // Straight on, a delay of 30 ms at 0.5 m/s is a place 15 mm farther back.
  EXPECT_NE(result.quantities[kForward].refusal, "");
  EXPECT_NEAR(result.quantities[kYaw].correction, 0.03, kYawTolerance);
  EXPECT_EQ(result.Correction()[kForward], 0.0);
}

TEST(Calibrate, RefusesADriveThatShowsTooLittle) {
  PostsDrive drive;
  drive.seconds = 1.0;
  EXPECT_NE(CalibrationOf(drive).refusal.find("too few pairs"), std::string::npos);
  EXPECT_NE(Calibrate(CalibrationData{}, {}).refusal.find("too few pairs: 0"), std::string::npos);
}

TEST(Calibrate, RefusesEdgesThatAreNotOnThePosts) {
  PostsDrive drive;
  drive.posts_in_pictures = false;
  drive.clutter = 40;
  const std::string refusal = CalibrationOf(drive).refusal;
  EXPECT_NE(refusal.find("no place of the camera fits"), std::string::npos) << refusal;
}

}  // namespace
}  // namespace scan_image_slam
