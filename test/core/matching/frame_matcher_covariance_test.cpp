// The covariance that the matching of the paper tells, and where a corridor misleads it.
#include "core/matching/frame_matcher_fixtures.h"
#include "scan_image_slam/core/matching/frame_matcher.h"
#include "support_rooms.h"

#include <cmath>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

TEST(FrameMatcherCovariance, IsSmallWhereTheCostIsSteep) {
  const MatchOutcome outcome = MatchAfter(FurnishedRoom(), kPose, Pose2(), Pose2());
  EXPECT_LT(outcome.covariance(0, 0), 0.1 * 0.01 * 0.01);
  EXPECT_LT(outcome.covariance(2, 2), 0.1 * 0.02 * 0.02);
  EXPECT_NEAR(outcome.covariance(1, 1), 0.005 * 0.005, 1e-12);  // sideways nothing is searched
  EXPECT_NEAR(outcome.covariance(0, 2), outcome.covariance(2, 0), 1e-15);
  EXPECT_GT(outcome.covariance.determinant(), 0.0);
}

TEST(FrameMatcherCovariance, IsThatOfThePredictionWithoutPoints) {
  FrameMatcher matcher(CoarseOptions());
  matcher.Start(ModelLitAt({}));
  const Eigen::Matrix3d covariance = matcher.Match(ModelLitAt({}), Predicted(Pose2())).covariance;
  EXPECT_NEAR((covariance - Predicted(Pose2()).covariance).norm(), 0.0, 1e-15);
}

TEST(FrameMatcherCovariance, IsAsByHand) {
  // Three points at 2 m, farther apart than any step: going s forward and turning by a moves each
  // by s^2 - 2 s a y + 4 a^2 (squared). Steps of 0.04 leave higher orders of about 1 %.
  const std::vector<int> lit{-5, 10, 20};
  double sum_y = 0.0;
  for (const int degree : lit) sum_y += 2.0 * std::sin(degree * M_PI / 180.0);
  FrameMatcher matcher(CoarseOptions());
  matcher.Start(ModelLitAt(lit));
  const Eigen::Matrix3d covariance = matcher.Match(ModelLitAt(lit), Predicted(Pose2())).covariance;
  Eigen::Matrix3d information = Predicted(Pose2()).covariance.inverse();
  const double one_point = 1.0 / (CoarseOptions().range_stddev * CoarseOptions().range_stddev);
  information(0, 0) += 3.0 * one_point;
  information(2, 2) += 12.0 * one_point;
  information(0, 2) -= sum_y * one_point;
  information(2, 0) -= sum_y * one_point;
  const Eigen::Matrix3d expected = information.inverse();
  EXPECT_NEAR(covariance(0, 0), expected(0, 0), 0.01 * expected(0, 0));
  EXPECT_NEAR(covariance(1, 1), expected(1, 1), 0.01 * expected(1, 1));
  EXPECT_NEAR(covariance(2, 2), expected(2, 2), 0.01 * expected(2, 2));
  EXPECT_NEAR(covariance(0, 2), expected(0, 2), 0.03 * std::abs(expected(0, 2)));
}

}  // namespace
}  // namespace scan_image_slam
