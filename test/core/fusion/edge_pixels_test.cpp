#include "scan_image_slam/core/fusion/edge_filter.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

constexpr int kRows = 12;
constexpr int kColumns = 40;
constexpr int kStep = 20;  ///< first column on the right of the steps below

/// Dark and light meet between columns 19 and 20, in rows [begin, end).
cv::Mat Step(int left, int right, int begin = 0, int end = kRows) {
  cv::Mat grey(kRows, kColumns, CV_8U, cv::Scalar(left));
  grey(cv::Range(begin, end), cv::Range(kStep, kColumns)).setTo(right);
  return grey;
}

/// An edge as a lens with a Gaussian blur of 0.8 px shows it.
cv::Mat BlurredEdge(double column, double left, double right) {
  cv::Mat grey(kRows, kColumns, CV_8U);
  for (int y = 0; y < kRows; ++y) {
    for (int x = 0; x < kColumns; ++x) {
      const double share = 0.5 * (1.0 + std::erf((x - column) / (0.8 * std::sqrt(2.0))));
      grey.at<std::uint8_t>(y, x) =
          static_cast<std::uint8_t>(std::lround(left + (right - left) * share));
    }
  }
  return grey;
}

int Count(const cv::Mat& sign, int value) { return cv::countNonZero(sign == value); }

/// The one edge pixel of a row; -1 if there is not exactly one.
int EdgeColumn(const cv::Mat& sign, int row) {
  int column = -1;
  for (int x = 0; x < sign.cols; ++x) {
    if (sign.at<std::int8_t>(row, x) == 0) continue;
    if (column >= 0) return -1;
    column = x;
  }
  return column;
}

TEST(FindEdgePixels, AStepIsOnePixelWideAndHasTheSignOfWhatIsOnItsRight) {
  for (const int sign : {1, -1}) {
    const EdgePixels edges =
        FindEdgePixels(sign > 0 ? Step(60, 180) : Step(180, 60), /*threshold=*/20.0);
    EXPECT_EQ(Count(edges.sign, sign), kRows);
    EXPECT_EQ(Count(edges.sign, 0), kRows * (kColumns - 1));
    for (int y = 0; y < kRows; ++y) {
      EXPECT_NEAR(EdgeColumn(edges.sign, y), kStep - 0.5, 0.5) << y;
    }
  }
}

TEST(FindEdgePixels, AStepFarBelowTheThresholdIsNone) {
  EXPECT_EQ(cv::countNonZero(FindEdgePixels(Step(100, 106), 20.0).sign), 0);
  EXPECT_EQ(Count(FindEdgePixels(Step(100, 106), 8.0).sign, 1), kRows);
}

TEST(FollowChains, AChainNeedsAStepAboveTheThreshold) {
  EXPECT_EQ(FollowChains(FindEdgePixels(Step(100, 114), 20.0), 20.0).size(), 0U);
  EXPECT_EQ(FollowChains(FindEdgePixels(Step(100, 122), 20.0), 20.0).size(), 1U);
}

TEST(FollowChains, AFaintPartOfAStrongEdgeBelongsToIt) {
  cv::Mat grey = Step(100, 160);
  for (int y = 0; y < kRows; ++y) {  // a step of 60 at the top, of 14 at the bottom
    grey(cv::Range(y, y + 1), cv::Range(kStep, kColumns)).setTo(160 - 46 * y / (kRows - 1));
  }
  const std::vector<EdgeChain> chains = FollowChains(FindEdgePixels(grey, 20.0), 20.0);
  ASSERT_EQ(chains.size(), 1U);
  EXPECT_EQ(chains[0].pixels.size(), static_cast<std::size_t>(kRows));
}

TEST(FindEdgePixels, AnEvenPictureHasNone) {
  EXPECT_EQ(cv::countNonZero(FindEdgePixels(Step(128, 128), 1.0).sign), 0);
}

TEST(FindEdgePixels, TheGradientOfARampIsTwiceItsSlope) {
  cv::Mat grey(kRows, kColumns, CV_8U);
  for (int x = 0; x < kColumns; ++x) grey.col(x).setTo(5 * x);
  const EdgePixels edges = FindEdgePixels(grey, 20.0);
  for (int x = 3; x < kColumns - 3; ++x) {
    EXPECT_EQ(edges.gradient.at<std::int16_t>(kRows / 2, x), 2 * 5);
  }
}

/// How far off the column of a blurred edge is, at worst over its places within a pixel.
double WorstColumnError(double contrast) {
  double worst = 0.0;
  for (int i = -10; i <= 10; ++i) {
    const double column = 20.0 + 0.049 * i;
    for (const double rise : {contrast, -contrast}) {
      const cv::Mat grey = BlurredEdge(column, 120.0 - 0.5 * rise, 120.0 + 0.5 * rise);
      const EdgePixels edges = FindEdgePixels(grey, 5.0);
      const int x = EdgeColumn(edges.sign, kRows / 2);
      EXPECT_GE(x, 0) << column;
      worst = std::max(worst, std::abs(SubpixelColumn(edges, {x, kRows / 2}) - column));
    }
  }
  return worst;
}

TEST(SubpixelColumn, FindsABlurredEdgeToATwentiethOfAPixel) {
  EXPECT_LT(WorstColumnError(160.0), 0.05);
}

/// Gradients of one row.
EdgePixels Gradients(const std::vector<std::int16_t>& row) {
  EdgePixels edges;
  edges.gradient = cv::Mat(row, true).reshape(1, 1);
  return edges;
}

TEST(SubpixelColumn, IsTheVertexOfTheParabola) {
  // Through (-1, 2), (0, 4), (1, 3): y = 4 + x/2 - 3/2 x^2, whose vertex is at 1/6.
  EXPECT_NEAR(SubpixelColumn(Gradients({0, 2, 4, 3, 0}), {2, 0}), 2.0 + 1.0 / 6.0, 1e-15);
  EXPECT_NEAR(SubpixelColumn(Gradients({0, -2, -4, -3, 0}), {2, 0}), 2.0 + 1.0 / 6.0, 1e-15);
}

TEST(SubpixelColumn, NeverLeavesThePixel) {
  EXPECT_EQ(SubpixelColumn(Gradients({0, 50, 40, 10, 0}), {2, 0}), 1.5);
  EXPECT_EQ(SubpixelColumn(Gradients({0, 10, 40, 50, 0}), {2, 0}), 2.5);
}

TEST(SubpixelColumn, WithoutAPeakItIsThePixel) {
  EXPECT_EQ(SubpixelColumn(Gradients({7, 7, 7, 7}), {1, 0}), 1.0);
  EXPECT_EQ(SubpixelColumn(Gradients({9, 7, 9, 7}), {1, 0}), 1.0);
}

TEST(SubpixelColumn, AtTheBorderItIsThePixel) {
  EXPECT_EQ(SubpixelColumn(Gradients({9, 7, 3}), {0, 0}), 0.0);
  EXPECT_EQ(SubpixelColumn(Gradients({3, 7, 9}), {2, 0}), 2.0);
}

}  // namespace
}  // namespace scan_image_slam
