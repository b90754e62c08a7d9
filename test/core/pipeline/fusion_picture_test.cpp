#include "scan_image_slam/core/pipeline/fusion_picture.h"

#include "support_fusion.h"

#include <cmath>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace scan_image_slam {
namespace {

/// In front of a light wall with a dark stripe: two edges, dark to light on its right side.
class FusionPictureTest : public testing::Test {
 protected:
  void SetUp() override {
    PaintedWorld world;
    world.AddWall({2.0, 3.0}, {2.0, -3.0}).paints.push_back({2.7, 3.3, 0.0, 5.0, 40.0});
    CameraView view;
    view.centre = {0.0, 0.0, 0.5};
    fusion_.SetLaser({Pose2(), 0.3});
    fusion_.SetCamera(PinholeCamera(), view.FromOptical());
    fusion_.AddImage({1'000'000'000, world.Picture(PinholeCamera(), view.FromOptical()), nullptr});
    LaserScan scan = world.Scan(Pose2(), -1.0, 0.01, 201);
    scan.stamp = 1'000'000'000;
    model_ = fusion_.Fuse(scan);
    ASSERT_EQ(model_.edges.size(), 2U);
    ASSERT_EQ(fusion_.evidence().edges.size(), 2U);
  }

  /// Pixels of a colour, within a grey level or two of it, around an edge of the image, in the rows
  /// of the camera's picture.
  int Count(const cv::Mat& picture, int edge, const cv::Scalar& colour) const {
    const ImageEdge& seen = fusion_.evidence().edges[edge];
    const cv::Point2f p = fusion_.bearing_image()->CameraPixel(
        static_cast<int>(std::lround(seen.column)), (seen.top + seen.bottom) / 2);
    const cv::Mat around = picture(cv::Rect(static_cast<int>(p.x) - 4, 0, 9, 240));
    cv::Mat found;
    cv::inRange(around, colour - cv::Scalar::all(2), colour + cv::Scalar::all(2), found);
    return cv::countNonZero(found);
  }

  MatchedMotion MatchWith(EdgeUse first, double residual = 0.0) const {
    MatchedMotion match;
    match.edges = {{first, residual}, {EdgeUse::kMatched, 0.0}};
    return match;
  }

  ScanImageFusion fusion_{ScanImageFusionOptions()};
  FusedModel model_;
  const cv::Scalar kCyan{255, 200, 0}, kOrange{0, 140, 255}, kViolet{220, 70, 160}, kRed{0, 0, 255},
      kWhite = cv::Scalar::all(255);
};

TEST_F(FusionPictureTest, IsEmptyBeforeTheFirstImage) {
  EXPECT_TRUE(DrawFusion(ScanImageFusion(ScanImageFusionOptions()), FusedModel(), nullptr).empty());
}

TEST_F(FusionPictureTest, ShowsTheEdgesInTheColourOfTheirSign) {
  const cv::Mat picture = DrawFusion(fusion_, model_, nullptr);
  EXPECT_EQ(picture.cols, 320);
  EXPECT_GT(picture.rows, 240);
  EXPECT_GT(Count(picture, 0, kCyan), 30);
  EXPECT_EQ(Count(picture, 0, kOrange), 0);
  EXPECT_GT(Count(picture, 1, kOrange), 30);
  EXPECT_EQ(Count(picture, 1, kCyan), 0);
}

TEST_F(FusionPictureTest, TellsMatchedNewLeftOutAndRefusedEdgesApart) {
  const auto first = [&](EdgeUse use, const cv::Scalar& colour) {
    const MatchedMotion match = MatchWith(use);
    return Count(DrawFusion(fusion_, model_, &match), 0, colour);
  };
  EXPECT_GT(first(EdgeUse::kMatched, kCyan), 30);
  EXPECT_GT(first(EdgeUse::kNew, kCyan), 5);
  EXPECT_LT(first(EdgeUse::kNew, kCyan), first(EdgeUse::kMatched, kCyan) / 2) << "thin";
  EXPECT_GT(first(EdgeUse::kLeftOut, kViolet), 5);
  EXPECT_EQ(first(EdgeUse::kLeftOut, kCyan), 0);
  EXPECT_GT(first(EdgeUse::kRefused, kRed), 30);
  EXPECT_EQ(first(EdgeUse::kRefused, kCyan), 0);
}

TEST_F(FusionPictureTest, PointsToWhereAMatchedEdgeWasExpected) {
  const auto white = [&](double residual) {
    const MatchedMotion match = MatchWith(EdgeUse::kMatched, residual);
    const cv::Mat picture = DrawFusion(fusion_, model_, &match);
    cv::Mat found;
    cv::inRange(picture(cv::Rect(0, 0, 320, 240)), kWhite - cv::Scalar::all(2), kWhite, found);
    cv::Mat places;
    cv::findNonZero(found, places);
    return places.empty() ? cv::Rect() : cv::boundingRect(places);
  };
  // A column and a half to the left, which is to smaller columns, so it was expected on the right.
  const double step = fusion_.bearing_image()->step();
  const double column = fusion_.evidence().edges[0].column;
  const cv::Rect line = white(1.5 * step);
  EXPECT_NEAR(line.width, 30, 3);
  EXPECT_NEAR(line.x, fusion_.bearing_image()->CameraPixel(std::lround(column), 10).x, 3.0);
  EXPECT_NEAR(white(-1.5 * step).x, line.x - 30, 3);
}

TEST_F(FusionPictureTest, IsDrawnAsIfUnmatchedIfTheMatchIsOfOtherEdges) {
  MatchedMotion match;
  match.edges = {{EdgeUse::kRefused, 0.0}};
  const cv::Mat picture = DrawFusion(fusion_, model_, &match);
  EXPECT_EQ(Count(picture, 0, kRed), 0);
  EXPECT_GT(Count(picture, 0, kCyan), 30);
}

}  // namespace
}  // namespace scan_image_slam
