#include "scan_image_slam/core/fusion/scan_image_fusion.h"
#include "support_fusion.h"

#include <cmath>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

/// What is fused before a wall on the left, a metre away, with a dark door from 2 m to 2.5 m ahead.
FusedModel BesideADoor(const ScanImageFusionOptions& options) {
  PaintedWorld world;
  world.floor_height = 0.0;
  world.AddWall({-40.0, 1.0}, {40.0, 1.0}).paints.push_back({42.0, 42.5, 0.0, 2.0, 60.0});
  const CameraIntrinsics camera = PinholeCamera();
  CameraView view;
  view.centre = {0.0, 0.0, 0.5};
  ScanImageFusion fusion(options);
  LaserMount laser;
  laser.height = 0.4;
  fusion.SetLaser(laser);
  fusion.SetCamera(camera, view.FromOptical());
  fusion.AddImage({0, world.Picture(camera, view.FromOptical()), nullptr});
  LaserScan scan = world.Scan(Pose2(), -M_PI, 2.0 * M_PI / 720, 720);
  scan.range_max = 10.0;
  return fusion.Fuse(scan);
}

TEST(EdgeOnAWall, IsWhereItsRayMeetsTheWall) {
  const FusedModel model = BesideADoor(ScanImageFusionOptions());
  ASSERT_EQ(model.edges.size(), 2U);
  EXPECT_NEAR(model.edges[0].point().x(), 2.0, 0.02);  // from left to right
  EXPECT_NEAR(model.edges[1].point().x(), 2.5, 0.02);
  for (const ModelEdge& edge : model.edges) EXPECT_NEAR(edge.point().y(), 1.0, 0.005);
}

TEST(EdgeOnAWall, KnowsHowItsRangeGrowsWithTheBearing) {
  for (const ModelEdge& edge : BesideADoor(ScanImageFusionOptions()).edges) {
    // The wall is at y = 1: range = 1 / sin(bearing).
    const double sine = std::sin(edge.bearing);
    EXPECT_NEAR(edge.range_by_bearing, -std::cos(edge.bearing) / (sine * sine), 0.05);
  }
}

TEST(EdgeOnAWall, IsNotUsedWhereTheWallIsSeenTooSlanted) {
  // Metres of wall in a radian: 1 / sin^2, that is 5 at 2 m ahead and 7.25 at 2.5 m.
  ScanImageFusionOptions options;
  options.max_edge_slant = 6.0;
  const FusedModel model = BesideADoor(options);
  ASSERT_EQ(model.edges.size(), 1U);
  EXPECT_NEAR(model.edges[0].point().x(), 2.0, 0.02);
  options.max_edge_slant = 4.0;
  EXPECT_TRUE(BesideADoor(options).edges.empty());
  options.max_edge_slant = 0.0;
  EXPECT_THROW(ScanImageFusion{options}, std::invalid_argument);
}

}  // namespace
}  // namespace scan_image_slam
