#include "scan_image_slam/core/fusion/edge_extraction.h"

#include "core/fusion/painted_cylinder.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

constexpr int kTop = 60;  ///< rows of the region of interest: 100 of them
constexpr int kBottom = 159;

class EdgeExtractionTest : public PaintedCylinder {};

TEST_F(EdgeExtractionTest, AStripeHasTwoEdgesFromLeftToRight) {
  const std::vector<ImageEdge> edges = Extract({{100.3, 130.8, 0, 239, 60.0}});
  ASSERT_EQ(edges.size(), 2U);
  EXPECT_NEAR(edges[0].column, 100.3, 0.1);
  EXPECT_EQ(edges[0].sign, -1);
  EXPECT_NEAR(edges[1].column, 130.8, 0.1);
  EXPECT_EQ(edges[1].sign, 1);
}

TEST_F(EdgeExtractionTest, AnEdgeThroughTheWholeRegionHasTheFullWeight) {
  const ImageEdge edge = Extract({{100, 400, 0, 239, 60.0}}).at(0);
  EXPECT_EQ(edge.top, kTop / kRow);
  EXPECT_EQ(edge.bottom, kBottom / kRow);
  EXPECT_EQ(edge.strength, 2.0 * (100.0 - kRow));
  EXPECT_NEAR(edge.weight, 0.96, 1e-12);
}

TEST_F(EdgeExtractionTest, TheWeightIsTheShareOfTheRegion) {
  const ImageEdge edge = Extract({{100, 400, 80, 119, 60.0}}).at(0);  // 40 of 100 rows
  EXPECT_NEAR(edge.weight, 0.4, 0.05);
  EXPECT_NEAR(edge.top, 80 / kRow, 1);
  EXPECT_NEAR(edge.bottom, 119 / kRow, 1);
}

TEST_F(EdgeExtractionTest, WhatIsAboveOrBelowTheRegionIsNotSeen) {
  EXPECT_TRUE(Extract({{100, 400, 10, kTop - 1 - kRow, 60.0}}).empty());
  EXPECT_TRUE(Extract({{100, 400, kBottom + 1 + kRow, 220, 60.0}}).empty());
  EXPECT_EQ(Extract({{100, 400, kTop, kTop + 46, 60.0}}).size(), 1U);
}

TEST_F(EdgeExtractionTest, ColumnsOutsideTheRegionAreNotSeen) {
  for (int c = 90; c <= 110; ++c) region_.bottom[c] = kTop / kRow - 1;
  const std::vector<ImageEdge> edges = Extract({{100, 130, 0, 239, 60.0}});
  ASSERT_EQ(edges.size(), 1U);
  EXPECT_NEAR(edges[0].column, 130.0, 0.1);
}

TEST_F(EdgeExtractionTest, WithoutARegionThereIsNothing) {
  region_.begin = image_.rows();
  region_.end = 0;
  EXPECT_TRUE(Extract({{100, 130, 0, 239, 60.0}}).empty());
}

TEST_F(EdgeExtractionTest, AnEdgeMustBeLongEnoughInMetres) {
  // 20 rows are 0.2 m at 3 m, and 0.1 m at 1.5 m.
  const std::vector<Patch> poster{{100, 400, 90, 109, 60.0}};
  EXPECT_EQ(Extract(poster).size(), 1U);
  SetSurface(1.5);
  EXPECT_TRUE(Extract(poster).empty());
}

TEST_F(EdgeExtractionTest, AnEdgeMustBeLongEnoughInRows) {
  // 20 rows are long enough in metres at any of these distances.
  const std::vector<Patch> poster{{100, 400, 90, 109, 60.0}};
  EdgeExtractionOptions options = ExtractionOptions();
  options.min_edge_rows = 15.0;
  EXPECT_EQ(Extract(poster, options).size(), 1U);
  options.min_edge_rows = 25.0;
  EXPECT_TRUE(Extract(poster, options).empty());
}

TEST_F(EdgeExtractionTest, TheEdgesOfAThinLineStayApart) {
  EdgeExtractionOptions options = ExtractionOptions();
  options.column_tolerance = 10.0;
  const std::vector<ImageEdge> edges = Extract({{100, 104, 0, 239, 60.0}}, options);
  ASSERT_EQ(edges.size(), 2U);
  EXPECT_EQ(edges[0].sign, -1);
  EXPECT_EQ(edges[1].sign, 1);
}

TEST_F(EdgeExtractionTest, ASlantedEdgeIsLessSureOfItsColumn) {
  std::vector<Patch> slanted;  // three pixels to the left over the region
  for (int i = 0; i < 100; ++i) {
    slanted.push_back({120.0 - 0.03 * i, 400, kTop + i, kTop + i, 60.0});
  }
  const ImageEdge straight = Extract({{100, 400, 0, 239, 60.0}}).at(0);
  const ImageEdge leaning = Extract(slanted).at(0);
  EXPECT_LT(straight.column_stddev, 0.05);
  EXPECT_GT(leaning.column_stddev, 2.0 * straight.column_stddev);
  EXPECT_NEAR(leaning.column, 118.5, 0.3);
}

TEST_F(EdgeExtractionTest, FainterEdgesHaveLessContrast) {
  const double strong = Extract({{100, 400, 0, 239, 60.0}}).at(0).contrast;
  const double faint = Extract({{100, 400, 0, 239, 120.0}}).at(0).contrast;
  EXPECT_NEAR(faint / strong, 0.5, 0.03);
}

TEST_F(EdgeExtractionTest, AnEdgeLiesOnASurfaceWhenAnyLengthWillDo) {
  EdgeExtractionOptions options = ExtractionOptions();
  options.min_edge_length = 0.0;  // which Validate allows
  for (int u = 40; u < 280; ++u) {
    cv::Mat picture(240, 320, CV_8U, cv::Scalar(180));
    picture.colRange(u, 320).setTo(60);
    SetSurface(3.0);
    SetRegion(kTop, kBottom);
    const ImageEdge edge = ExtractEdges(picture, image_, profile_, region_, options).at(0);
    for (int c = static_cast<int>(edge.column) + 1; c < image_.columns(); ++c) {
      profile_.columns[c] = {};
      region_.bottom[c] = kTop / kRow - 1;
    }
    for (const ImageEdge& e : ExtractEdges(picture, image_, profile_, region_, options)) {
      EXPECT_GE(profile_.columns[std::lround(e.column)].beam, 0) << e.column;
    }
  }
}

class PlainPictureOf : public ::testing::TestWithParam<CameraView> {};

TEST_P(PlainPictureOf, HasNoEdgesAtItsBorder) {
  const BearingImage image(CameraModel(PinholeCamera()), GetParam().FromOptical());
  SurfaceProfile profile;
  profile.columns.assign(image.columns(), {3.0, 0});
  RegionOfInterest region;
  region.top.assign(image.columns(), 0);
  region.bottom.assign(image.columns(), image.rows() - 1);
  region.end = image.rows();
  EdgeExtractionOptions options = ExtractionOptions();
  options.min_edge_length = 0.0;
  options.min_edge_rows = 1.0;
  const cv::Mat white(240, 320, CV_8U, cv::Scalar(255));
  EXPECT_TRUE(ExtractEdges(white, image, profile, region, options).empty());
}

INSTANTIATE_TEST_SUITE_P(Mountings, PlainPictureOf,
                         ::testing::Values(CameraView{}, CameraView{{0, 0, 0}, 0.4, 0.2, 0.0},
                                           CameraView{{0, 0, 0}, 0.0, 0.0, 30 * kDegree},
                                           CameraView{{0, 0, 0}, 0.0, -0.3, 85 * kDegree}));

}  // namespace
}  // namespace scan_image_slam
