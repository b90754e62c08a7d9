#include "scan_image_slam/core/calibration/upright_edges.h"

#include "support_fusion.h"

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

TEST(FitUprightEdge, FindsTheLineThroughPixels) {
  std::vector<cv::Point2d> pixels;
  for (int row = 10; row <= 50; ++row) pixels.emplace_back(100.0 + 0.05 * (row - 30), row);
  const UprightEdge edge = FitUprightEdge(pixels, 8.0);
  ASSERT_EQ(edge.top, 10);
  ASSERT_EQ(edge.bottom, 50);
  EXPECT_NEAR(edge.row, 30.0, 1e-9);
  EXPECT_NEAR(edge.column, 100.0, 1e-9);
  EXPECT_NEAR(edge.lean, 0.05, 1e-9);
  EXPECT_NEAR(edge.ColumnAt(50), 101.0, 1e-9);
}

TEST(FitUprightEdge, LeavesOutThePixelsRoundACorner) {
  std::vector<cv::Point2d> pixels;
  for (int row = 10; row <= 50; ++row) pixels.emplace_back(100.0, row);
  for (int column = 101; column <= 112; ++column) pixels.emplace_back(column, 50);
  const UprightEdge edge = FitUprightEdge(pixels, 8.0);
  ASSERT_GE(edge.bottom, edge.top);
  EXPECT_NEAR(edge.ColumnAt(20), 100.0, 0.05);
}

TEST(FitUprightEdge, RefusesWhatIsShortOrSlantedOrCrooked) {
  std::vector<cv::Point2d> few;
  std::vector<cv::Point2d> slanted;
  std::vector<cv::Point2d> crooked;
  for (int row = 0; row < 40; ++row) {
    if (row < 7) few.emplace_back(100.0, row);
    slanted.emplace_back(100.0 + 0.3 * row, row);
    crooked.emplace_back(100.0 + (row % 2 == 0 ? 0.95 : -0.95), row);
  }
  for (const auto& pixels : {few, slanted, crooked}) {
    const UprightEdge edge = FitUprightEdge(pixels, 8.0);
    EXPECT_LT(edge.bottom, edge.top);
  }
}

/// A dark post between two bearings before a bright wall, seen by a level camera at the origin.
cv::Mat PictureOfPost(double right, double left, double roll) {
  CameraView view;
  view.roll = roll;
  return RenderPicture(PinholeCamera(), view.FromOptical(),
                       [&](const Eigen::Vector3d&, const Eigen::Vector3d& ray) {
                         const double bearing = std::atan2(ray.y(), ray.x());
                         return right < bearing && bearing < left ? 60.0 : 180.0;
                       });
}

TEST(FindUprightEdges, FindsBothSidesOfAPost) {
  const BearingImage image(CameraModel(PinholeCamera()), CameraView().FromOptical());
  const auto edges = FindUprightEdges(PictureOfPost(0.10, 0.16, 0.0), image, 0, image.rows(), {});
  ASSERT_EQ(edges.size(), 2U);
  const double a = image.Bearing(edges[0].column);
  const double b = image.Bearing(edges[1].column);
  EXPECT_NEAR(std::min(a, b), 0.10, 0.2 * image.step());
  EXPECT_NEAR(std::max(a, b), 0.16, 0.2 * image.step());
  EXPECT_NEAR(edges[0].lean, 0.0, 0.002 * BearingImage::kRowPixels);
}

TEST(FindUprightEdges, LeanByTheRollThatIsNotKnown) {
  // The camera is rolled clockwise, but taken to be level: what is upright leans counter-clockwise
  // in its picture, so that edges come from the right below and go to the left above.
  constexpr double kRoll = 0.03;
  const BearingImage image(CameraModel(PinholeCamera()), CameraView().FromOptical());
  const auto edges =
      FindUprightEdges(PictureOfPost(-0.03, 0.03, kRoll), image, 0, image.rows(), {});
  ASSERT_EQ(edges.size(), 2U);
  for (const UprightEdge& edge : edges) {
    EXPECT_NEAR(edge.lean / BearingImage::kRowPixels, kRoll, 0.003);
  }
}

}  // namespace
}  // namespace scan_image_slam
