#include "scan_image_slam/core/evaluation/map_quality_picture.h"

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

// Blue, green, red.
const cv::Vec3b kBlack(0, 0, 0);
const cv::Vec3b kRed(0, 0, 230);
const cv::Vec3b kOrange(0, 140, 255);
const cv::Vec3b kGreen(60, 190, 60);
const cv::Vec3b kWhite(254, 254, 254);
constexpr int kCaption = 108;  // below the map, for four lines [px]

/// 80 x 40 free cells of 1 m from (0, 0) on, a wall at y = 20, and what is wrong with it.
class MapQualityPicture : public ::testing::Test {
 protected:
  MapQualityPicture() {
    map_.width = 80;
    map_.height = 40;
    map_.resolution = 1.0;
    map_.occupancy.assign(3200, 0);
    map_.occupancy[20 * 80 + 30] = 100;
    map_.occupancy[10 * 80 + 40] = 100;
    plan_.walls = {{{20.0, 20.0}, {60.0, 20.0}}};
    plan_.seen = {{30.5, 20.0}, {50.5, 20.0}};
  }
  /// Ten pixels per cell; the pixel at a point [m] of the map.
  static cv::Vec3b At(const cv::Mat& picture, double x, double y) {
    return picture.at<cv::Vec3b>(picture.rows - kCaption - 1 - static_cast<int>(10 * y),
                                 static_cast<int>(10 * x));
  }
  cv::Mat Draw(const Pose2& world_from_map) const {
    MapQualityOptions options;
    options.tolerance = 1.0;
    const MapQuality quality = EvaluateMap(map_, plan_, world_from_map, options);
    return DrawMapQuality(map_, plan_, world_from_map, quality, 800);
  }

  MapImage map_;
  TruePlan plan_;
};

TEST_F(MapQualityPicture, ColoursWhatIsRightAndWrong) {
  const cv::Mat picture = Draw({});
  ASSERT_EQ(picture.size(), cv::Size(800, 400 + kCaption));
  EXPECT_EQ(At(picture, 30.5, 20.5), kBlack);
  EXPECT_EQ(At(picture, 40.5, 10.5), kRed);
  EXPECT_EQ(At(picture, 40.95, 10.95), kRed);
  EXPECT_EQ(At(picture, 41.5, 10.5), kWhite);
  EXPECT_EQ(At(picture, 50.5, 19.99), kOrange);
  EXPECT_LT(cv::norm(At(picture, 25.0, 19.99), kGreen), 50.0);  // smoothed
  EXPECT_EQ(At(picture, 15.0, 19.99), kWhite);
}

TEST_F(MapQualityPicture, MovesTheTruthIntoTheMap) {
  plan_.walls = {{{0.0, 120.0}, {0.0, 160.0}}};
  plan_.seen.clear();
  // Map (x, y) lies at world (20 - y, 100 + x).
  const cv::Mat picture = Draw({20.0, 100.0, M_PI_2});
  EXPECT_LT(cv::norm(At(picture, 25.0, 19.99), kGreen), 50.0);  // smoothed
  EXPECT_EQ(At(picture, 30.5, 20.5), kBlack);
}

TEST_F(MapQualityPicture, GrowsToHoldTheTruth) {
  plan_.walls.push_back({{20.0, 20.0}, {20.0, 59.0}});
  EXPECT_EQ(Draw({}).size(), cv::Size(800, 600 + kCaption));
}

TEST(EmptyMapQualityPicture, IsEmpty) {
  EXPECT_TRUE(DrawMapQuality(MapImage(), TruePlan(), {}, MapQuality()).empty());
}

}  // namespace
}  // namespace scan_image_slam
