#include "scan_image_slam/core/simulation/camera_simulator.h"

#include "plain_world.h"

#include <cmath>
#include <optional>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

/// Where the grey value passes `level`, between two pixels of a row near its middle.
std::optional<double> Crossing(const cv::Mat& image, int row, double level) {
  for (int u = image.cols / 2 - 12; u < image.cols / 2 + 12; ++u) {
    const double a = image.at<std::uint8_t>(row, u) - level;
    const double b = image.at<std::uint8_t>(row, u + 1) - level;
    if (a * b <= 0.0 && a != b) return u + a / (a - b);
  }
  return std::nullopt;
}

TEST(CameraSimulator, FreeRunningTimesAndLatency) {
  const World world = PlainRoom(4.0, 4.0);
  CameraSimulatorOptions options = SharpCamera();
  options.rate_error = 0.01;
  CameraSimulator camera(world, options, 1, FromSeconds(50.0));
  const SimulatedImage first = camera.Skip();
  const SimulatedImage second = camera.Skip();
  EXPECT_EQ(first.stamp, FromSeconds(50.0 + 0.011 + 0.004));
  EXPECT_NEAR(Seconds(second.stamp - first.stamp), 1.0 / 30.3, 1e-8);
  EXPECT_NEAR(Seconds(first.arrival - first.stamp), 0.004 + 0.028, 1e-8);
}

/// Width of an edge between its 10 % and 90 % points [px].
double EdgeWidth(const cv::Mat& image, int row, double dark, double bright) {
  const std::optional<double> low = Crossing(image, row, dark + 0.1 * (bright - dark));
  const std::optional<double> high = Crossing(image, row, dark + 0.9 * (bright - dark));
  EXPECT_TRUE(low && high);
  return std::abs(*high - *low);
}

TEST(CameraSimulator, TurningBlursByAngleTimesFocalLength) {
  World world = EmptyWorld();
  AddPlainWall(world, {5.0, -9.0}, {5.0, 0.0}, 60.0);
  AddPlainWall(world, {5.0, 0.0}, {5.0, 9.0}, 200.0);
  CameraSimulatorOptions options = SharpCamera();
  options.mount = {0.0, 0.0, 0.55, 0.0, 0.0, 0.0};
  options.centre_x = 0.0;
  options.motion_blur = true;
  const double turn_rate = 1.5;
  const auto width = [&](double rate) {
    CameraSimulator camera(world, options, 1, 0);
    // The edge passes the middle of the image in the middle of the exposure.
    const double middle = options.phase + options.exposure / 2.0;
    const MotionHistory history = ConstantMotion(Pose2{0.0, 0.0, -rate * middle}, 0.0, rate);
    const double shade = 0.84 + 0.16 * 0.6;
    return EdgeWidth(camera.Take(history).pixels, 240, 60.0 * shade, 200.0 * shade);
  };
  const double smear = turn_rate * options.exposure * TrueLens(options).fx;  // 5 px
  EXPECT_LT(width(0.0), 1.8);
  EXPECT_NEAR(width(turn_rate), 0.8 * smear, 0.8);
}

TEST(CameraSimulator, BrightnessFollowsExposureAndSaturates) {
  const World world = PlainRoom(6.0, 6.0);
  CameraSimulatorOptions options = SharpCamera();
  const auto grey = [&](double exposure) {
    options.exposure = exposure;
    CameraSimulator camera(world, options, 1, 0);
    const cv::Mat image = camera.Take(ConstantMotion({2.0, 3.0, 0.0}, 0.0, 0.0)).pixels;
    return static_cast<double>(image.at<std::uint8_t>(150, 320));
  };
  const double normal = grey(0.008);
  EXPECT_NEAR(grey(0.004), 0.5 * normal, 1.5);
  EXPECT_EQ(grey(0.020), 255.0);
}

TEST(CameraSimulator, NoiseHasReadAndShotPart) {
  const World world = PlainRoom(6.0, 6.0);
  CameraSimulatorOptions options = SharpCamera();
  options.read_noise = 1.5;
  options.shot_noise = 0.03;
  CameraSimulator camera(world, options, 3, 0);
  for (const double level : {40.0, 200.0}) {
    const cv::Mat image = camera.TakeUniform(level).pixels;
    cv::Scalar mean;
    cv::Scalar stddev;
    cv::meanStdDev(image, mean, stddev);
    EXPECT_NEAR(mean[0], level, 0.1);
    const double rounding = 1.0 / 12.0;
    EXPECT_NEAR(stddev[0], std::sqrt(1.5 * 1.5 + 0.03 * level + rounding), 0.06);
  }
}

TEST(CameraSimulator, GreyAndBayerAgreeWithColour) {
  World world = PlainRoom(6.0, 6.0);
  for (Face& face : world.faces) face.colour = {180, 90, 40};
  CameraSimulatorOptions options = SharpCamera();
  const auto take = [&](ImageEncoding encoding) {
    options.encoding = encoding;
    CameraSimulator camera(world, options, 1, 0);
    return camera.Take(ConstantMotion({2.0, 3.0, 0.0}, 0.0, 0.0)).pixels;
  };
  const cv::Vec3b colour = take(ImageEncoding::kBgr8).at<cv::Vec3b>(150, 320);
  const cv::Mat bayer = take(ImageEncoding::kBayerRggb8);
  EXPECT_NEAR(take(ImageEncoding::kMono8).at<std::uint8_t>(150, 320),
              0.114 * colour[0] + 0.587 * colour[1] + 0.299 * colour[2], 1.5);
  EXPECT_GT(colour[2], 1.9 * colour[1]);
  EXPECT_EQ(bayer.at<std::uint8_t>(150, 320), colour[2]);
  EXPECT_EQ(bayer.at<std::uint8_t>(150, 321), colour[1]);
  EXPECT_EQ(bayer.at<std::uint8_t>(151, 321), colour[0]);
}

}  // namespace
}  // namespace scan_image_slam
