#include "scan_image_slam/core/fusion/edge_extraction.h"
#include "support_fusion.h"
#include "support_options.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

constexpr double kCameraHeight = 1.0;
constexpr double kLaserHeight = 0.3;

/// A level camera: its rows see slopes from -0.4 to 0.4.
BearingImage Image() {
  return BearingImage(CameraModel(PinholeCamera()),
                      CameraView{{0, 0, kCameraHeight}}.FromOptical());
}

/// A surface at the same distance in every column.
SurfaceProfile Around(const BearingImage& image, double distance) {
  SurfaceProfile profile;
  profile.columns.resize(image.columns());
  for (SurfaceProfile::Column& column : profile.columns) column = {distance, 0};
  return profile;
}

EdgeExtractionOptions Reaching(double below, double above) {
  EdgeExtractionOptions options;
  options.roi_below = below;
  options.roi_above = above;
  return options;
}

RegionOfInterest RegionAt(double distance, double below, double above) {
  const BearingImage image = Image();
  return MakeRegionOfInterest(Around(image, distance), image, kLaserHeight, Reaching(below, above));
}

TEST(EdgeExtractionOptions, NamesTheFieldThatIsWrong) {
  EXPECT_NO_THROW(EdgeExtractionOptions().Validate());
  for (const double nonsense : {-0.1, std::nan("")}) {
    ExpectRefused(&EdgeExtractionOptions::roi_below, nonsense, "roi_below");
    ExpectRefused(&EdgeExtractionOptions::roi_above, nonsense, "roi_above");
    ExpectRefused(&EdgeExtractionOptions::edge_threshold, nonsense, "edge_threshold");
    ExpectRefused(&EdgeExtractionOptions::min_edge_length, nonsense, "min_edge_length");
    ExpectRefused(&EdgeExtractionOptions::min_edge_rows, nonsense, "min_edge_rows");
    ExpectRefused(&EdgeExtractionOptions::column_tolerance, nonsense, "column_tolerance");
  }
  ExpectRefused(&EdgeExtractionOptions::edge_threshold, 0.0, "edge_threshold");
  ExpectRefused(&EdgeExtractionOptions::column_tolerance, 0.0, "column_tolerance");
}

TEST(EdgeExtractionOptions, ARegionWithoutHeightIsRefused) {
  EXPECT_NO_THROW(Reaching(0.0, 0.5).Validate());
  EXPECT_NO_THROW(Reaching(0.5, 0.0).Validate());
  EXPECT_THROW(Reaching(0.0, 0.0).Validate(), std::invalid_argument);
}

TEST(RegionOfInterest, IsTheBandAroundTheLasersLine) {
  // From 0.1 to 0.6 m above the floor, seen from 1 m: 0.9 and 0.4 m below the camera.
  const BearingImage image = Image();
  for (const double distance : {2.5, 4.0}) {
    const RegionOfInterest region = RegionAt(distance, 0.2, 0.3);
    for (int c = 0; c < image.columns(); ++c) {
      EXPECT_NEAR(image.Slope(region.top[c]), -0.4 / distance, image.row_step()) << c;
      EXPECT_NEAR(image.Slope(region.bottom[c]), -0.9 / distance, image.row_step()) << c;
    }
  }
}

TEST(RegionOfInterest, FollowsTheSurfaceColumnByColumn) {
  const BearingImage image = Image();
  SurfaceProfile profile = Around(image, 4.0);
  profile.columns[100].distance = 2.5;
  const RegionOfInterest region =
      MakeRegionOfInterest(profile, image, kLaserHeight, Reaching(0.2, 0.3));
  EXPECT_NEAR(image.Slope(region.top[99]), -0.1, image.row_step());
  EXPECT_NEAR(image.Slope(region.top[100]), -0.16, image.row_step());
  EXPECT_EQ(region.begin, region.top[99]);
  EXPECT_EQ(region.end, region.bottom[100] + 1);
}

TEST(RegionOfInterest, EndsAtThePicture) {
  const BearingImage image = Image();
  const RegionOfInterest region = RegionAt(1.0, 0.3, 3.0);  // slopes from -1 to 2.3
  EXPECT_EQ(region.top[50], 0);
  EXPECT_EQ(region.bottom[50], image.rows() - 1);
  EXPECT_EQ(region.begin, 0);
  EXPECT_EQ(region.end, image.rows());
}

TEST(RegionOfInterest, WithoutASurfaceThereIsNone) {
  const BearingImage image = Image();
  SurfaceProfile profile = Around(image, 0.0);
  profile.columns[70].distance = 3.0;
  const RegionOfInterest region =
      MakeRegionOfInterest(profile, image, kLaserHeight, Reaching(0.2, 0.3));
  for (int c = 0; c < image.columns(); ++c) {
    EXPECT_EQ(region.bottom[c] >= region.top[c], c == 70) << c;
  }
  EXPECT_EQ(region.begin, region.top[70]);
  EXPECT_EQ(region.end, region.bottom[70] + 1);
}

TEST(RegionOfInterest, WithoutAnySurfaceItHasNoRows) {
  const RegionOfInterest region = RegionAt(0.0, 0.2, 0.3);
  EXPECT_GE(region.begin, region.end);
}

/// The region of a laser that is so much above the camera, with a band of 10 cm at 1 m.
RegionOfInterest RegionOfLaserAbove(double height) {
  const BearingImage image = Image();
  return MakeRegionOfInterest(Around(image, 1.0), image, kCameraHeight + height,
                              Reaching(0.05, 0.05));
}

TEST(RegionOfInterest, ABandAboveThePictureIsNone) {
  const RegionOfInterest region = RegionOfLaserAbove(0.9);
  EXPECT_LT(region.bottom[50], region.top[50]);
  EXPECT_GE(region.begin, region.end);
}

TEST(RegionOfInterest, ABandBelowThePictureIsNone) {
  const RegionOfInterest region = RegionOfLaserAbove(-0.9);
  EXPECT_LT(region.bottom[50], region.top[50]);
  EXPECT_GE(region.begin, region.end);
}

}  // namespace
}  // namespace scan_image_slam
