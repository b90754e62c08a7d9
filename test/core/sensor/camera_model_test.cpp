#include "scan_image_slam/core/sensor/camera_model.h"

#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

constexpr double kFx = 500.0;
constexpr double kFy = 400.0;
constexpr double kCx = 322.0;
constexpr double kCy = 238.0;

CameraIntrinsics Camera(const std::string& model, const std::vector<double>& d) {
  CameraIntrinsics intrinsics;
  intrinsics.width = 640;
  intrinsics.height = 480;
  intrinsics.k = cv::Matx33d(kFx, 0, kCx, 0, kFy, kCy, 0, 0, 1);
  intrinsics.distortion_model = model;
  intrinsics.d = d;
  return intrinsics;
}

const std::vector<double> kPlumbBob{-0.28, 0.09, 0.001, -0.002, -0.01};
const std::vector<double> kRational{0.1, -0.05, 0.001, -0.002, 0.02, 0.4, -0.03, 0.01};
const std::vector<double> kEquidistant{-0.02, 0.01, -0.004, 0.001};

/// Brown's lens in the plane at distance 1, with the denominator of the rational model.
cv::Point2d BrownLens(double x, double y, const std::vector<double>& d) {
  const double r2 = x * x + y * y;
  double radial = 1.0 + d[0] * r2 + d[1] * r2 * r2 + d[4] * r2 * r2 * r2;
  if (d.size() == 8) radial /= 1.0 + d[5] * r2 + d[6] * r2 * r2 + d[7] * r2 * r2 * r2;
  return {x * radial + 2.0 * d[2] * x * y + d[3] * (r2 + 2.0 * x * x),
          y * radial + d[2] * (r2 + 2.0 * y * y) + 2.0 * d[3] * x * y};
}

/// Kannala and Brandt's fisheye in the plane at distance 1.
cv::Point2d FisheyeLens(double x, double y, const std::vector<double>& k) {
  const double r = std::hypot(x, y);
  if (r == 0.0) return {0.0, 0.0};
  const double t = std::atan(r);
  const double t2 = t * t;
  const double distorted =
      t * (1.0 + k[0] * t2 + k[1] * t2 * t2 + k[2] * t2 * t2 * t2 + k[3] * t2 * t2 * t2 * t2);
  return {x * distorted / r, y * distorted / r};
}

cv::Point2f ProjectOne(const CameraIntrinsics& intrinsics, const cv::Point3d& point) {
  return CameraModel(intrinsics).Project({point}).front();
}

void ExpectPixel(const cv::Point2f& pixel, double u, double v, double tolerance = 1e-3) {
  EXPECT_NEAR(pixel.x, u, tolerance);
  EXPECT_NEAR(pixel.y, v, tolerance);
}

void ExpectNotSeen(const cv::Point2f& pixel) { EXPECT_EQ(pixel, cv::Point2f(-1.0f, -1.0f)); }

void ExpectProjectsBy(const CameraIntrinsics& intrinsics,
                      const std::function<cv::Point2d(double, double)>& lens) {
  const CameraModel camera(intrinsics);
  for (double x = -0.5; x <= 0.5; x += 0.125) {
    for (double y = -0.4; y <= 0.4; y += 0.1) {
      const cv::Point2d p = lens(x, y);
      const cv::Point2f pixel = camera.Project({{2.0 * x, 2.0 * y, 2.0}}).front();
      ExpectPixel(pixel, kCx + kFx * p.x, kCy + kFy * p.y);
    }
  }
}

TEST(CameraModel, PinholeByHand) {
  ExpectPixel(ProjectOne(Camera("plumb_bob", {}), {0.2, -0.1, 2.0}), 322 + 50, 238 - 20, 1e-4);
  ExpectPixel(ProjectOne(Camera("", {}), {0.0, 0.0, 7.0}), 322, 238, 1e-4);
}

TEST(CameraModel, PlumbBobIsBrownsFormula) {
  ExpectProjectsBy(Camera("plumb_bob", kPlumbBob),
                   [](double x, double y) { return BrownLens(x, y, kPlumbBob); });
}

TEST(CameraModel, RationalPolynomialHasADenominator) {
  ExpectProjectsBy(Camera("rational_polynomial", kRational),
                   [](double x, double y) { return BrownLens(x, y, kRational); });
}

TEST(CameraModel, EquidistantIsAPolynomialOfTheAngle) {
  for (const char* name : {"equidistant", "fisheye"}) {
    ExpectProjectsBy(Camera(name, kEquidistant),
                     [](double x, double y) { return FisheyeLens(x, y, kEquidistant); });
  }
}

TEST(CameraModel, PointsBehindAreNotSeen) {
  const CameraIntrinsics intrinsics = Camera("plumb_bob", {});
  ExpectNotSeen(ProjectOne(intrinsics, {0.0, 0.0, -2.0}));
  ExpectNotSeen(ProjectOne(intrinsics, {0.0, 0.0, 0.0}));
  ExpectNotSeen(ProjectOne(Camera("equidistant", kEquidistant), {0.01, 0.0, -2.0}));
}

TEST(CameraModel, PixelsReachHalfAPixelOverTheirCentres) {
  const CameraModel camera(Camera("plumb_bob", {}));
  const auto project = [&](double u, double v) {
    return camera.Project({{(u - kCx) / kFx, (v - kCy) / kFy, 1.0}}).front();
  };
  ExpectPixel(project(-0.49, 100.0), -0.49, 100.0);
  ExpectNotSeen(project(-0.51, 100.0));
  ExpectPixel(project(639.49, 100.0), 639.49, 100.0);
  ExpectNotSeen(project(639.51, 100.0));
  ExpectPixel(project(100.0, -0.49), 100.0, -0.49);
  ExpectNotSeen(project(100.0, -0.51));
  ExpectPixel(project(100.0, 479.49), 100.0, 479.49);
  ExpectNotSeen(project(100.0, 479.51));
}

TEST(CameraModel, PointsFoldedBackByThePolynomialAreNotSeen) {
  const std::vector<double> fold{-0.3, 0.0, 0.0, 0.0, 0.0};
  const cv::Point2d inside = BrownLens(1.7, 0.0, fold);  // the formula alone would show it
  ASSERT_LT(kCx + kFx * inside.x, 640.0);
  const std::vector<cv::Point2f> pixels =
      CameraModel(Camera("plumb_bob", fold)).Project({{1.7, 0.0, 1.0}, {0.1, 0.0, 1.0}});
  ExpectNotSeen(pixels[0]);
  EXPECT_GT(pixels[1].x, kCx);
}

TEST(CameraModel, EveryPointKeepsItsPlace) {
  const CameraModel camera(Camera("plumb_bob", {}));
  const std::vector<cv::Point2f> pixels =
      camera.Project({{0, 0, -1}, {0.2, 0, 2}, {9, 0, 1}, {0, 0.1, 2}});
  ASSERT_EQ(pixels.size(), 4U);
  ExpectNotSeen(pixels[0]);
  ExpectPixel(pixels[1], 372, 238);
  ExpectNotSeen(pixels[2]);
  ExpectPixel(pixels[3], 322, 258);
  EXPECT_TRUE(camera.Project({}).empty());
}

TEST(CameraModel, TheRayOfAPixelByHand) {
  const Eigen::Vector3d ray =
      CameraModel(Camera("plumb_bob", {})).Ray(322.0 + 250.0, 238.0 - 100.0);
  EXPECT_NEAR((ray - Eigen::Vector3d(0.5, -0.25, 1.0).normalized()).norm(), 0.0, 1e-12);
}

TEST(CameraModel, RayIsTheInverseOfProjectAllOverThePicture) {
  for (const CameraIntrinsics& intrinsics :
       {Camera("plumb_bob", {}), Camera("plumb_bob", kPlumbBob),
        Camera("rational_polynomial", kRational), Camera("equidistant", kEquidistant)}) {
    const CameraModel camera(intrinsics);
    for (double u = 0.0; u <= 639.0; u += 71.0) {
      for (double v = 0.0; v <= 479.0; v += 479.0 / 6.0) {
        const Eigen::Vector3d ray = camera.Ray(u, v);
        EXPECT_NEAR(ray.norm(), 1.0, 1e-12);
        ExpectPixel(camera.Project({{3.0 * ray.x(), 3.0 * ray.y(), 3.0 * ray.z()}}).front(), u, v);
      }
    }
  }
}

}  // namespace
}  // namespace scan_image_slam
