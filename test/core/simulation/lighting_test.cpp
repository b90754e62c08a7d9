#include "scan_image_slam/core/simulation/lighting.h"

#include "plain_world.h"
#include "scan_image_slam/core/simulation/scene_view.h"

#include <cmath>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

Lighting WithDarkRegion() {
  Lighting lighting;
  lighting.brightness = 0.8;
  LightRegion region;
  region.low = {10.0, -5.0};
  region.high = {20.0, 5.0};
  region.brightness = 0.1;
  region.border = 2.0;
  region.blur = 3.0;
  lighting.regions = {region};
  return lighting;
}

TEST(Lighting, RegionsFadeInFromTheirBorder) {
  const Lighting lighting = WithDarkRegion();
  EXPECT_DOUBLE_EQ(BrightnessAt(lighting, {9.9, 0.0}), 0.8);
  EXPECT_NEAR(BrightnessAt(lighting, {11.0, 0.0}), 0.8 * 0.55, 1e-12);  // half way in
  EXPECT_NEAR(BrightnessAt(lighting, {15.0, 0.0}), 0.08, 1e-12);
  EXPECT_NEAR(BlurAt(lighting, {15.0, 0.0}), 3.0, 1e-12);
  EXPECT_DOUBLE_EQ(BlurAt(lighting, {25.0, 0.0}), 0.0);
  EXPECT_DOUBLE_EQ(PeakBrightness(lighting), 0.8);
}

TEST(Lighting, FlickerIsAveragedOverTheExposure) {
  Lighting lighting;
  lighting.flicker = 0.2;
  lighting.flicker_frequency = 100.0;
  EXPECT_NEAR(FlickerFactor(lighting, 0.0025, 0.0), 1.2, 1e-9);
  EXPECT_NEAR(FlickerFactor(lighting, 0.0025, 0.010), 1.0, 1e-9);  // one whole period
  EXPECT_NEAR(FlickerFactor(lighting, 0.0025, 0.005), 1.0 + 0.2 * 2.0 / M_PI, 1e-9);
}

/// The spots on a wall along x, seen and lit from 1 m beside it.
std::vector<Spot> SpotsFrom(double camera_x, double lamp_x, double highlights, double shadows) {
  World world = EmptyWorld();
  AddPlainWall(world, {0.0, 0.0}, {20.0, 0.0});
  world.lighting.highlights = highlights;
  world.lighting.shadows = shadows;
  world.lighting.lamps = {{{lamp_x, 1.0}, 2.5}};
  SceneView view;
  view.position = {camera_x, 1.0};
  view.robot = {camera_x, 0.2};
  view.height = 0.5;
  BearingGrid grid;
  grid.tangent_min = -1.0;
  grid.tangent_step = 0.01;
  grid.columns = 200;
  return MakeViewedScene(world, view, grid).walls.at(0).spots;
}

TEST(Highlights, LieWhereTheLampIsMirroredAndMoveWithTheCamera) {
  const std::vector<Spot> spots = SpotsFrom(4.0, 8.0, 0.5, 0.0);
  ASSERT_EQ(spots.size(), 1U);
  EXPECT_NEAR(spots[0].along, 6.0, 1e-12);  // half way, both are 1 m from the wall
  EXPECT_NEAR(spots[0].height, 1.5, 1e-12);
  EXPECT_TRUE(spots[0].bright);
  EXPECT_NEAR(SpotsFrom(5.0, 8.0, 0.5, 0.0).at(0).along, 6.5, 1e-12);
}

TEST(Shadows, LieBehindTheRobot) {
  const std::vector<Spot> spots = SpotsFrom(4.0, 3.5, 0.0, 0.5);
  ASSERT_EQ(spots.size(), 1U);
  EXPECT_NEAR(spots[0].along, 4.125, 1e-12);  // from 3.5 at 1 m over 4.0 at 0.2 m
  EXPECT_FALSE(spots[0].bright);
}

TEST(Spots, AreOffByDefault) { EXPECT_TRUE(SpotsFrom(4.0, 8.0, 0.0, 0.0).empty()); }

}  // namespace
}  // namespace scan_image_slam
