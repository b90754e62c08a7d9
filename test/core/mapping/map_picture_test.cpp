#include "scan_image_slam/core/mapping/map_picture.h"

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

const cv::Vec3b kBlack(0, 0, 0);
const cv::Vec3b kWhite(254, 254, 254);
const cv::Vec3b kGrey(205, 205, 205);
const cv::Vec3b kPaper(255, 255, 255);
const cv::Vec3b kInk(40, 40, 40);
constexpr int kCaption = 60;  // below the map, for up to two lines [px]
const cv::Scalar kRed(0, 0, 255);
const cv::Vec3b kRedPixel(0, 0, 255);

/// 40 x 20 cells of 1 m from (-10, 5): free, with one wall cell and one unknown one.
MapImage Hall() {
  MapImage map;
  map.width = 40;
  map.height = 20;
  map.resolution = 1.0;
  map.origin_x = -10.0;
  map.origin_y = 5.0;
  map.occupancy.assign(800, 0);
  map.occupancy[15 * 40 + 30] = 100;  // x 20 ... 21 m, y 20 ... 21 m
  map.occupancy[15 * 40 + 32] = -1;
  return map;
}

cv::Vec3b At(const cv::Mat& picture, int x, int y) { return picture.at<cv::Vec3b>(y, x); }

TEST(MapPicture, FillsTheSideThatIsAskedFor) {
  const cv::Mat picture = DrawMap(Hall(), {}, 800);
  EXPECT_EQ(picture.type(), CV_8UC3);
  EXPECT_EQ(picture.cols, 800);
  EXPECT_EQ(picture.rows, 400 + kCaption);
}

TEST(MapPicture, ShowsTheMapFromAboveWithYUpwards) {
  const cv::Mat picture = DrawMap(Hall(), {}, 800);  // 20 pixels per cell
  for (const int inside : {0, 19}) {
    EXPECT_EQ(At(picture, 600 + inside, 80 + inside), kBlack);
    EXPECT_EQ(At(picture, 640 + inside, 80 + inside), kGrey);
  }
  EXPECT_EQ(At(picture, 599, 90), kWhite);
  EXPECT_EQ(At(picture, 620, 90), kWhite);
  EXPECT_EQ(At(picture, 610, 79), kWhite);
  EXPECT_EQ(At(picture, 610, 100), kWhite);
}

TEST(MapPicture, DrawsPathsInTheMapsFrame) {
  DrawnPath path{"way", kRed, {{5.0, 10.0, 0.0}, {25.0, 10.0, 0.0}}};
  const cv::Mat picture = DrawMap(Hall(), {path}, 800);
  EXPECT_EQ(At(picture, 300, 300), kRedPixel);  // (5, 10) is 15 cells from the left, 5 from below
  EXPECT_EQ(At(picture, 500, 300), kRedPixel);
  EXPECT_EQ(At(picture, 700, 300), kRedPixel);
  EXPECT_EQ(At(picture, 700, 304), kRedPixel);  // the dot at its end
  EXPECT_EQ(At(picture, 290, 300), kWhite);
  EXPECT_EQ(At(picture, 500, 290), kWhite);
}

TEST(MapPicture, GrowsToHoldPathsThatLeaveTheMap) {
  DrawnPath path{"way", kRed, {{-25.0, 40.0, 0.0}, {40.0, -15.0, 0.0}}};
  const cv::Mat picture = DrawMap(Hall(), {path}, 670);
  // 1 m more than the path on each side: -26 ... 41 and -16 ... 41, at 10 pixels per cell.
  EXPECT_EQ(picture.cols, 670);
  EXPECT_EQ(picture.rows, 570 + kCaption);
  EXPECT_EQ(At(picture, 140, 120), kRedPixel);
  EXPECT_EQ(At(picture, 660, 560), kRedPixel);
  EXPECT_EQ(At(picture, 465, 205), kBlack);  // the wall at (20.5, 20.5)
  EXPECT_EQ(At(picture, 485, 205), kGrey);
  EXPECT_EQ(At(picture, 655, 205), kGrey);  // outside of the map
}

TEST(MapPicture, CutsPathsThatGoFarAway) {
  // The map is 40 m wide: 20 m around it count.
  DrawnPath path{"way", kRed, {{-25.0, 40.0, 0.0}, {40.0, -15.0, 0.0}, {5000.0, -15.0, 0.0}}};
  const cv::Mat picture = DrawMap(Hall(), {path}, 670);
  EXPECT_EQ(picture.cols, 670);
  EXPECT_EQ(picture.rows, 570 + kCaption);
  EXPECT_EQ(At(picture, 140, 120), kRedPixel);
  EXPECT_EQ(At(picture, 669, 560), kRedPixel);
}

TEST(MapPicture, HasAScaleBarOfARoundLength) {
  // A fifth of 40 m is 8 m, and 5 m is the next round length: 100 pixels from x = 20.
  const cv::Mat picture = DrawMap(Hall(), {}, 800);
  EXPECT_EQ(At(picture, 20, 438), kInk);
  EXPECT_EQ(At(picture, 120, 438), kInk);
  EXPECT_EQ(At(picture, 125, 438), kPaper);
  MapImage fine = Hall();
  fine.resolution = 0.05;  // 2 m: a fifth is 0.4 m, so 0.2 m or 80 pixels
  EXPECT_EQ(At(DrawMap(fine, {}, 800), 100, 438), kInk);
  EXPECT_EQ(At(DrawMap(fine, {}, 800), 105, 438), kPaper);
}

TEST(MapPicture, NothingIsWrittenOverTheMap) {
  MapImage full = Hall();
  full.occupancy.assign(800, 100);
  const DrawnPath path{"way", kRed, {}};
  const cv::Mat picture = DrawMap(full, {path, path, path}, 800);
  ASSERT_EQ(picture.rows, 400 + kCaption + 24);
  EXPECT_EQ(cv::norm(picture.rowRange(0, 400)), 0.0);
  EXPECT_EQ(At(picture, 5, 400), kPaper);
}

TEST(MapPicture, HasALegendBesideTheScaleBar) {
  const DrawnPath path{"way", kRed, {}};
  const cv::Mat picture = DrawMap(Hall(), {path, path}, 800);
  EXPECT_EQ(At(picture, 170, 419), kRedPixel);
  EXPECT_EQ(At(picture, 170, 443), kRedPixel);
  EXPECT_EQ(At(picture, 170, 431), kPaper);
}

TEST(MapPicture, IsAsWideAsItsLegend) {
  MapImage narrow = Hall();
  narrow.width = 1;
  narrow.height = 800;
  const DrawnPath path{"a name that is longer than this map is wide", kRed, {}};
  const cv::Mat picture = DrawMap(narrow, {path}, 800);
  EXPECT_GT(picture.cols, 300);
  EXPECT_EQ(At(picture, 1, 0), kPaper);
  EXPECT_EQ(cv::countNonZero(picture.col(picture.cols - 10).reshape(1) != 255), 0);
}

TEST(MapPicture, ShowsPathsWithoutAMap) {
  DrawnPath path{"way", kRed, {{3.0, 0.0, 0.0}, {4.0, 2.0, 0.0}}};
  const cv::Mat picture = DrawMap(MapImage(), {path}, 400);
  EXPECT_FALSE(picture.empty());
}

TEST(MapPicture, OfNothingIsEmpty) { EXPECT_TRUE(DrawMap(MapImage(), {}, 400).empty()); }

}  // namespace
}  // namespace scan_image_slam
