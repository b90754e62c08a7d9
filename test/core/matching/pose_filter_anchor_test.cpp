// From where on the pose is measured once walls come into view that tell of the way.
#include "core/matching/pose_filter_fixtures.h"
#include "scan_image_slam/core/matching/pose_filter.h"

#include <cmath>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

/// Drives straight on, told `told_by_true` times the way. With `scans` a laser that is exact to
/// 1 mm tells the way on from where the filter thought to be.
void Drive(double distance, double told_by_true, bool scans, PoseFilter* filter) {
  constexpr double kStep = 0.05;
  const double from = filter->map_from_base().x;
  const int steps = static_cast<int>(std::lround(distance / kStep));
  for (int i = 1; i <= steps; ++i) {
    filter->Predict(filter->map_from_base(), Forward(kStep * told_by_true),
                    Noise(2e-4, 2e-4, 1e-4));
    if (!scans) continue;
    filter->AddScan({from + i * kStep, 0.0, 0.0}, Noise(1e-3, 1e-3, 1e-3).inverse(),
                    Eigen::Vector3d::Zero());
  }
}

TEST(PoseFilterAnchor, LeavesThePoseAndHowWellItIsKnown) {
  PoseFilter filter(Options());
  filter.Start({1.0, 2.0, 0.4});
  filter.Predict({1.0, 2.0, 0.4}, Forward(5.0), Noise(0.05, 0.01, 0.002));
  const Pose2 pose = filter.map_from_base();
  const Eigen::Matrix3d covariance = filter.PoseCovariance();
  filter.Anchor();
  EXPECT_EQ(filter.map_from_base().x, pose.x);
  EXPECT_EQ(filter.map_from_base().y, pose.y);
  EXPECT_NEAR(filter.PoseCovariance()(0, 0), covariance(0, 0), 1e-12);
  EXPECT_NEAR(filter.PoseCovariance()(1, 1), covariance(1, 1), 1e-12);
  EXPECT_NEAR(filter.PoseCovariance()(0, 1), covariance(0, 1), 1e-12);
  EXPECT_NEAR(filter.CovarianceFromAnchor()(0, 0), 0.0, 1e-12);
  EXPECT_NEAR(filter.CovarianceFromAnchor()(1, 1), covariance(1, 1), 1e-12);
  EXPECT_NEAR(filter.CovarianceFromAnchor()(2, 2), covariance(2, 2), 1e-12);
}

TEST(PoseFilterAnchor, WallsThatCameIntoViewTellNothingOfTheWayToThere) {
  PoseFilter filter(Options());
  filter.Start(Pose2());
  Drive(20.0, 0.98, /*scans=*/false, &filter);
  const double before = filter.PoseCovariance()(0, 0);
  EXPECT_NEAR(std::sqrt(before), 20.0 * 0.98 * Options().scale_stddev, 0.01);
  const double way = filter.map_from_base().x;
  filter.Anchor();
  Drive(10.0, 0.98, /*scans=*/true, &filter);
  EXPECT_NEAR(filter.map_from_base().x, way + 10.0, 0.002);
  EXPECT_GE(filter.PoseCovariance()(0, 0), before);
  EXPECT_NEAR(filter.PoseCovariance()(0, 0), before, 1e-5);
}

TEST(PoseFilterAnchor, WallsThatCameIntoViewTellTheScaleOfTheEncoders) {
  PoseFilter filter(Options());
  filter.Start(Pose2());
  Drive(20.0, 0.98, /*scans=*/false, &filter);
  filter.Anchor();
  Drive(10.0, 0.98, /*scans=*/true, &filter);
  EXPECT_NEAR(filter.learned().encoder_scale, 1.0 / 0.98, 0.001);
}

TEST(PoseFilterAnchor, EdgesInViewStayWhereTheyAreToTheBase) {
  PoseFilter filter(Options());
  filter.Start(Pose2());
  Drive(20.0, 1.0, /*scans=*/false, &filter);
  const Pose2 here = filter.map_from_base();
  const Eigen::Vector2d left = here * Eigen::Vector2d(1.5, 1.0);
  const Eigen::Vector2d right = here * Eigen::Vector2d(1.2, -1.0);
  Show({EdgeTo(left, here), EdgeTo(right, here)}, &filter);
  filter.Anchor();
  filter.Predict(here, Forward(0.1), Noise(0.05, kNothing, kNothing));
  const Pose2 there = here * Pose2{0.14, 0.0, 0.0};
  filter.AddEdges({EdgeTo(left, there), EdgeTo(right, there)});
  EXPECT_NEAR(filter.map_from_base().x, there.x, 0.005);
  EXPECT_LT(std::sqrt(filter.CovarianceFromAnchor()(0, 0)), 0.02);
}

TEST(PoseFilterAnchor, AStartForgetsIt) {
  PoseFilter filter(Options());
  filter.Start(Pose2());
  Drive(20.0, 1.0, /*scans=*/false, &filter);
  filter.Anchor();
  filter.Start(Pose2());
  EXPECT_EQ(filter.PoseCovariance()(0, 0), 0.0);
}

}  // namespace
}  // namespace scan_image_slam
