#include "scan_image_slam/core/fusion/bearing_image.h"

#include "support_fusion.h"

#include <cmath>
#include <ostream>
#include <stdexcept>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

constexpr double kFocal = 300.0;
constexpr double kHalfWidth =
    159.5;  // of the picture between the centres of its border pixels [px]
constexpr double kHalfHeight = 119.5;

BearingImage ImageOf(const CameraView& view, const CameraIntrinsics& intrinsics = PinholeCamera()) {
  return BearingImage(CameraModel(intrinsics), view.FromOptical());
}

struct Mounting {
  const char* name;
  CameraView view;
};
std::ostream& operator<<(std::ostream& out, const Mounting& m) { return out << m.name; }

const std::vector<Mounting> kMountings{
    {"level", {{0, 0, 0}, 0, 0, 0}},
    {"pitched down", {{0.1, 0, 1.2}, 0, 15 * kDegree, 0}},
    {"pitched up", {{0.1, 0, 0.3}, 0, -20 * kDegree, 0}},
    {"rolled by 30 degrees", {{0, 0, 0.5}, 0, 0, 30 * kDegree}},
    {"rolled by 90 degrees", {{0, 0, 0.5}, 0, 0, 90 * kDegree}},
    {"upside down", {{0, 0, 0.5}, 0, 0, 180 * kDegree}},
    {"yawed, off the middle", {{0.3, -0.2, 1.1}, 70 * kDegree, 0, 0}},
    {"backwards, across pi", {{-0.3, 0.1, 0.8}, 178 * kDegree, 0, 0}},
    {"all at once", {{0.3, -0.2, 1.1}, -100 * kDegree, 12 * kDegree, -25 * kDegree}}};

class BearingImageOf : public ::testing::TestWithParam<Mounting> {};

/// Column at which a row of a picture crosses the middle grey, between two pixels that the mask
/// allows; -1 if it does not.
double CrossingColumn(const cv::Mat& picture, const cv::Mat& mask, int row, double middle) {
  for (int c = 0; c + 1 < picture.cols; ++c) {
    if (mask.at<std::uint8_t>(row, c) == 0 || mask.at<std::uint8_t>(row, c + 1) == 0) continue;
    const double here = picture.at<std::uint8_t>(row, c) - middle;
    const double next = picture.at<std::uint8_t>(row, c + 1) - middle;
    if (here * next <= 0.0 && here != next) return c + here / (here - next);
  }
  return -1.0;
}

TEST_P(BearingImageOf, ShowsAVerticalEdgeOfTheWorldInOneColumn) {
  const CameraView& view = GetParam().view;
  const BearingImage image = ImageOf(view);
  const double edge = view.yaw + 3.3 * kDegree;
  const cv::Mat picture = RenderPicture(
      PinholeCamera(), view.FromOptical(), [&](const Eigen::Vector3d&, const Eigen::Vector3d& ray) {
        return std::sin(std::atan2(ray.y(), ray.x()) - edge) > 0.0 ? 60.0 : 180.0;
      });
  const cv::Mat levelled = image.Resample(picture, 0, image.rows());
  int rows = 0;
  for (int row = 0; row < image.rows(); ++row) {
    const double column = CrossingColumn(levelled, image.mask(), row, 120.0);
    if (column < 0.0) continue;
    ++rows;
    EXPECT_NEAR(std::remainder(image.Bearing(column) - edge, 2.0 * M_PI), 0.0, 0.05 * kDegree)
        << row;
  }
  EXPECT_GT(rows * BearingImage::kRowPixels, 150);
}

TEST_P(BearingImageOf, ShowsAHorizontalLineAroundTheRobotInOneRow) {
  const CameraView& view = GetParam().view;
  const BearingImage image = ImageOf(view);
  const double slope = -std::tan(view.pitch) + 0.05;
  const cv::Mat picture = RenderPicture(
      PinholeCamera(), view.FromOptical(), [&](const Eigen::Vector3d&, const Eigen::Vector3d& ray) {
        return ray.z() > slope * std::hypot(ray.x(), ray.y()) ? 60.0 : 180.0;
      });
  const cv::Mat levelled = image.Resample(picture, 0, image.rows()).t();
  const cv::Mat mask = image.mask().t();
  int columns = 0;
  for (int column = 0; column < image.columns(); ++column) {
    const double row = CrossingColumn(levelled, mask, column, 120.0);
    if (row < 0.0) continue;
    ++columns;
    EXPECT_NEAR(image.Slope(row), slope, 0.5 * image.row_step()) << column;
  }
  EXPECT_GT(columns, 150);
}

TEST_P(BearingImageOf, TheMaskKeepsTwoColumnsAndARowFromWhatTheCameraDoesNotSee) {
  const BearingImage image = ImageOf(GetParam().view);
  ASSERT_EQ(image.mask().rows, image.rows());
  ASSERT_EQ(image.mask().cols, image.columns());
  for (int row = 0; row < image.rows(); ++row) {
    for (int column = 0; column < image.columns(); ++column) {
      bool all = true;
      for (int i = 0; i < 15; ++i) {
        const int r = row + i / 5 - 1;
        const int c = column + i % 5 - 2;
        const bool inside = r >= 0 && c >= 0 && r < image.rows() && c < image.columns();
        all = all && inside && image.CameraPixel(c, r).x >= 0.0f && image.CameraPixel(c, r).y >= 0;
      }
      ASSERT_EQ(image.mask().at<std::uint8_t>(row, column), all ? 255 : 0) << row << ' ' << column;
    }
  }
}

TEST_P(BearingImageOf, ShowsMostOfThePictureAndNothingBesides) {
  const BearingImage image = ImageOf(GetParam().view);
  const cv::Mat white(240, 320, CV_8U, cv::Scalar(255));
  const cv::Mat levelled = image.Resample(white, 0, image.rows());
  EXPECT_GT(BearingImage::kRowPixels * cv::countNonZero(image.mask()), 0.6 * 240 * 320);
  EXPECT_EQ(cv::countNonZero((image.mask() == 255) & (levelled != 255)), 0);
  for (int row = 0; row < image.rows(); ++row) {
    for (int column = 0; column < image.columns(); ++column) {
      if (image.CameraPixel(column, row) != cv::Point2f(-1.0f, -1.0f)) continue;
      ASSERT_EQ(levelled.at<std::uint8_t>(row, column), 0) << row << ' ' << column;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Mountings, BearingImageOf, ::testing::ValuesIn(kMountings));

TEST(BearingImage, ALevelCameraByHand) {
  const BearingImage image = ImageOf({{0.3, -0.2, 1.1}, 0.5, 0, 0});
  const double half_view = std::atan(kHalfWidth / kFocal);
  EXPECT_EQ(image.centre(), Eigen::Vector3d(0.3, -0.2, 1.1));
  EXPECT_NEAR(image.step(), 1.0 / kFocal, 1e-15);
  EXPECT_NEAR(image.Bearing(0.0), 0.5 + half_view, 1e-9);
  EXPECT_NEAR(image.Slope(0.0), kHalfHeight / kFocal, 1e-5);
  EXPECT_NEAR(image.columns(), 2.0 * half_view * kFocal, 1.0);
  EXPECT_NEAR(image.rows() * BearingImage::kRowPixels, 2.0 * kHalfHeight, BearingImage::kRowPixels);
}

TEST(BearingImage, ColumnsFallInBearingAndRowsInSlope) {
  const BearingImage image = ImageOf({{0, 0, 0}, 0.5, 0.1, 0.2});
  EXPECT_NEAR(image.Bearing(7.0) - image.Bearing(8.5), 1.5 / kFocal, 1e-12);
  EXPECT_NEAR(image.Slope(7.0) - image.Slope(8.5), 1.5 * image.row_step(), 1e-12);
  EXPECT_NEAR(image.row_step(), BearingImage::kRowPixels / kFocal, 1e-15);
  EXPECT_NEAR(image.Column(image.Bearing(12.25)), 12.25, 1e-9);
  EXPECT_NEAR(image.Row(image.Slope(12.25)), 12.25, 1e-9);
}

TEST(BearingImage, ThePixelOfAPlaceByHand) {
  const BearingImage image = ImageOf({{0.3, -0.2, 1.1}, 0.5, 0, 0});
  for (const int column : {20, 150, 250}) {
    for (const int row : {18, 30, 40}) {
      const double angle = image.Bearing(column) - 0.5;
      const cv::Point2f pixel = image.CameraPixel(column, row);
      EXPECT_NEAR(pixel.x, kHalfWidth - kFocal * std::tan(angle), 1e-3);
      EXPECT_NEAR(pixel.y, kHalfHeight - kFocal * image.Slope(row) / std::cos(angle), 1e-3);
    }
  }
}

TEST(BearingImage, KeepsTheResolutionOfTheFinerAxis) {
  CameraIntrinsics intrinsics = PinholeCamera();
  intrinsics.k(1, 1) = 400.0;
  EXPECT_NEAR(ImageOf({}, intrinsics).step(), 1.0 / 400.0, 1e-15);
  intrinsics.k(0, 0) = 500.0;
  EXPECT_NEAR(ImageOf({}, intrinsics).step(), 1.0 / 500.0, 1e-15);
}

TEST(BearingImage, SomeRowsAreTheseRowsOfAll) {
  const BearingImage image = ImageOf({{0, 0, 0}, 0, 0.2, 0.3});
  cv::Mat grey(240, 320, CV_8U);
  for (int v = 0; v < 240; ++v) {
    for (int u = 0; u < 320; ++u) grey.at<std::uint8_t>(v, u) = (7 * u + 13 * v) % 251;
  }
  const cv::Mat all = image.Resample(grey, 0, image.rows());
  const cv::Mat some = image.Resample(grey, 10, 30);
  ASSERT_EQ(some.rows, 20);
  EXPECT_EQ(cv::countNonZero(some != all.rowRange(10, 30)), 0);
}

TEST(BearingImage, ACameraThatLooksStraightDownOrUpIsRefused) {
  for (const double pitch : {90.0, 75.0, -75.0, -90.0}) {
    EXPECT_THROW(ImageOf({{0, 0, 1}, 0, pitch * kDegree, 0}), std::invalid_argument) << pitch;
  }
  EXPECT_NO_THROW(ImageOf({{0, 0, 1}, 0, 60.0 * kDegree, 0}));
}

TEST(BearingImage, FocalLengthsThatMakeNoPictureAreRefused) {
  // One of them tells how fine the picture is, the other one how far it goes.
  for (const double focal : {1e7, 1e30}) {
    for (const int axis : {0, 1}) {
      CameraIntrinsics intrinsics = PinholeCamera();
      intrinsics.k(axis, axis) = focal;
      EXPECT_THROW(ImageOf({{0, 0, 1}, 0, 0, 0}, intrinsics), std::invalid_argument);
    }
  }
  CameraIntrinsics large = PinholeCamera(4096, 3072, 3000.0);
  EXPECT_NO_THROW(ImageOf({{0, 0, 1}, 0, 0, 0}, large));
}

TEST(BearingImage, ACameraThatSeesSteepRaysOnlyIsRefused) {
  EXPECT_THROW(ImageOf({{0, 0, 1}, 0, 72.4 * kDegree, 0}, PinholeCamera(320, 240, 20000.0)),
               std::invalid_argument);
}

}  // namespace
}  // namespace scan_image_slam
