// Small errors that are the same in every scan or image: many of them must not look like knowledge.
#include "pose_filter_fixtures.h"

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

/// Known to 0.5 m along a corridor, after a scan that shows its walls tilted and 1 mm aside.
PoseFilter BetweenTiltedWalls(double tilt) {
  PoseFilter filter(Options());
  filter.Start(Pose2());
  filter.Predict(Pose2(), Forward(0.0), Noise(0.5, 0.01, 0.01));
  const Eigen::Vector3d across(-std::sin(tilt), std::cos(tilt), 0.0);
  const Eigen::Matrix3d information = 1e6 * across * across.transpose();
  filter.AddScan(Pose2(), information, 1e3 * across);
  return filter;
}

TEST(PoseFilter, WallsThatSeemTiltedSayNothingOfTheWayAlong) {
  const PoseFilter filter = BetweenTiltedWalls(0.005);
  EXPECT_NEAR(filter.map_from_base().x, 0.0, 1e-9);
  EXPECT_NEAR(filter.map_from_base().y, -0.001, 2e-5);
  EXPECT_NEAR(filter.PoseCovariance()(0, 0), 0.25, 1e-9);
}

TEST(PoseFilter, WhoDrivesAskewIsToldOfTheWayByTheWalls) {
  // A tenth of the way shows across, where the prediction is known to 1 cm.
  const double forward_variance = BetweenTiltedWalls(0.1).PoseCovariance()(0, 0);
  EXPECT_NEAR(forward_variance, std::pow(0.01 / 0.1, 2), 0.001);
}

/// An edge at (4, 1) on a wall along x, as an image shows it from a place.
ModelEdge EdgeOnWall(const Pose2& map_from_base) {
  ModelEdge edge = EdgeTo({4.0, 1.0}, map_from_base);
  // The range along the wall is 1 / sin(bearing).
  edge.range_by_bearing = -std::cos(edge.bearing) / std::pow(std::sin(edge.bearing), 2);
  edge.range_stddev = 0.0;
  edge.bearing_stddev = 1e-4;
  return edge;
}

TEST(PoseFilter, ManyImagesDoNotWearAwayWhatShiftsAnEdge) {
  PoseFilterOptions options = Options();
  options.edges.surface_stddev = 1e-4;
  options.edge_bias = 100.0;  // 0.01 rad
  options.keep_distance = 10.0;
  options.camera_yaw_stddev = 0.0;
  PoseFilter filter(options);
  filter.Start(Pose2());
  for (int i = 0; i < 500; ++i) filter.AddEdges({EdgeOnWall(Pose2())});
  const Pose2 near{3.0, 0.0, 0.0};
  filter.Predict(Pose2(), Forward(3.0), Noise(1.0, kNothing, kNothing));
  for (int i = 0; i < 500; ++i) filter.AddEdges({EdgeOnWall(near)});
  // On the wall a radian is 1 / sin^2(bearing): 17 m from the start, 2 m from there. Of the shift
  // of 0.17 m, 0.02 m is left, and the rest cannot be told from the way that was driven.
  EXPECT_NEAR(std::sqrt(filter.PoseCovariance()(0, 0)), std::sqrt(0.17 * 0.17 - 0.02 * 0.02),
              0.005);
  EXPECT_NEAR(filter.map_from_base().x, 3.0, 0.001);
}

}  // namespace
}  // namespace scan_image_slam
