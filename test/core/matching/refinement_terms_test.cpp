// The terms of the least squares, one by one and by hand.
#include "core/matching/refinement_fixtures.h"
#include "scan_image_slam/core/matching/refinement.h"

#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

/// A wall 2 m ahead, in the map and in the scan; all points and elements have the same variances:
/// 1e-4 of the roughness, 1e-4 of the range, 1.01e-4 of the element.
constexpr double kVariance = 3.01e-4;

RefinementProblem WallProblem(int half_length_dm) {
  RefinementProblem problem;
  problem.noise = {0.01, 0.0};
  problem.map = LocalMap(LocalMapOptions(), problem.noise);
  problem.map.Insert(WallAhead(2.0, half_length_dm), Pose2());
  problem.points = WallAhead(2.0, half_length_dm);
  problem.options.model_stddev = 0.01;
  problem.options.correlation = 1.0;
  problem.options.kernel = 1e6;
  problem.prior.kernel = 1e6;
  return problem;
}

TEST(RefineTerms, InformationOfAWallByHand) {
  // Points at y = -0.2 ... 0.2: n is -x, so forward counts 5 times and the turn by the sum of y^2.
  const Refinement result = WallProblem(2).From(Pose2());
  const Eigen::Matrix3d& information = result.information;
  EXPECT_EQ(result.matched, 5);
  EXPECT_NEAR(information(0, 0), 5.0 / kVariance, 1e-3);
  EXPECT_NEAR(information(2, 2), 0.1 / kVariance, 1e-3);
  EXPECT_NEAR(information(1, 1), 0.0, 1e-3);
  EXPECT_NEAR(information(0, 2), 0.0, 1e-3);
}

TEST(RefineTerms, TurnAndForwardGoTogetherOffTheMiddle) {
  // Points at y = 0, 0.1, 0.2: turning by a moves them by -a * y along x, so n . = a * y and the
  // mixed term is -0.3.
  RefinementProblem problem = WallProblem(2);
  problem.points.erase(problem.points.begin(), problem.points.begin() + 2);
  const Eigen::Matrix3d information = problem.From(Pose2()).information;
  EXPECT_NEAR(information(0, 2), -0.3 / kVariance, 1e-3);
  EXPECT_NEAR(information(2, 0), -0.3 / kVariance, 1e-3);
}

TEST(RefineTerms, CorrelationDividesTheInformation) {
  RefinementProblem problem = WallProblem(2);
  problem.options.correlation = 10.0;
  EXPECT_NEAR(problem.From(Pose2()).information(0, 0), 0.5 / kVariance, 1e-3);
}

TEST(RefineTerms, CovarianceJoinsScanAndPrior) {
  RefinementProblem problem = WallProblem(2);
  problem.prior.covariance = Eigen::Vector3d(kVariance / 5.0, 0.01, kVariance / 0.3).asDiagonal();
  const Eigen::Matrix3d covariance = problem.From(Pose2()).covariance;
  EXPECT_NEAR(covariance(0, 0), kVariance / 10.0, 1e-9);
  EXPECT_NEAR(covariance(1, 1), 0.01, 1e-9);
  EXPECT_NEAR(covariance(2, 2), kVariance / 0.4, 1e-9);
}

TEST(RefineTerms, MeetsThePriorByTheirInformation) {
  // The scan says 0 with 5 points, the prior says 0.06 with a fifth of their information.
  RefinementProblem problem = WallProblem(2);
  problem.prior.map_from_base = {0.06, 0.0, 0.0};
  problem.prior.covariance = Eigen::Vector3d(kVariance, 0.01, 0.01).asDiagonal();
  EXPECT_NEAR(problem.From(Pose2()).map_from_base.x, 0.01, 1e-6);
  EXPECT_NEAR(problem.From({0.06, 0.0, 0.0}).map_from_base.x, 0.01, 1e-6);
}

/// Where a decreasing-through-zero function of one number vanishes.
double Root(double low, double high, const std::function<double(double)>& f) {
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (f(middle) * f(low) > 0.0 ? low : high) = middle;
  }
  return low;
}

TEST(RefineTerms, APriorBeyondItsKernelLosesWeight) {
  // As above, but the prior is sure to sqrt(kVariance / 5) and 5 of that are its kernel: minimum of
  // x^2 / s^2 + K^2 log(1 + (x - 0.08)^2 / (K s)^2), by bisection of the derivative.
  RefinementProblem problem = WallProblem(2);
  problem.options.max_iterations = 50;
  problem.prior.map_from_base = {0.08, 0.0, 0.0};
  problem.prior.kernel = 5.0;
  const double s2 = kVariance / 5.0;
  problem.prior.covariance = Eigen::Vector3d(s2, 0.01, 0.01).asDiagonal();
  const double expected = Root(0.0, 0.04, [&](double x) {
    return x / s2 + (x - 0.08) / s2 / (1.0 + (x - 0.08) * (x - 0.08) / (25.0 * s2));
  });
  EXPECT_LT(expected, 0.03);  // of 0.04 without the kernel
  EXPECT_NEAR(problem.From(Pose2()).map_from_base.x, expected, 1e-4);
}

TEST(RefineTerms, PointsBeyondTheKernelLoseWeight) {
  // Of 21 points 8 lie d behind the wall, 8 as far before it, and 5 lie 0.08 m before it. Minimum
  // of the sum of Cauchy's log(1 + r^2 / (kernel^2 variance)), by bisection of the derivative; the
  // eleventh of the squared residuals is that of the second 8, and the variance follows from it.
  constexpr double kOff = 0.008;
  RefinementProblem problem = WallProblem(10);
  problem.options.kernel = 2.0;
  problem.options.max_iterations = 50;
  for (std::size_t i = 0; i < problem.points.size(); ++i) {
    const double off = i % 5 == 0 ? -0.08 : (i % 5) % 2 == 0 ? kOff : -kOff;
    problem.points[i].point.x() += off;
  }
  problem.prior.covariance.diagonal() << 1e4, 1e-10, 1e-10;
  const double expected = Root(0.0, 0.08, [&](double x) {
    const double variance = (x + kOff) * (x + kOff) / 0.455;
    const auto influence = [&](double r) { return r / (1.0 + r * r / (4.0 * variance)); };
    return 8.0 * influence(x + kOff) + 8.0 * influence(x - kOff) + 5.0 * influence(x - 0.08);
  });
  EXPECT_LT(expected, 0.01);  // of 0.019, the mean
  EXPECT_NEAR(problem.From(Pose2()).map_from_base.x, expected, 1e-4);
}

TEST(RefineTerms, AnExactScanIsNotPulledByWrongNeighbours) {
  RefinementProblem problem = WallProblem(10);
  problem.options.kernel = 2.0;
  for (std::size_t i = 0; i < problem.points.size(); i += 5) problem.points[i].point.x() -= 0.08;
  problem.prior.covariance.diagonal() << 1e4, 1e-10, 1e-10;
  EXPECT_NEAR(problem.From(Pose2()).map_from_base.x, 0.0, 1e-4);
}

TEST(RefineTerms, VarianceFollowsTheResiduals) {
  // Half of 20 points lie behind the wall and half before it, by 0.01 m or by twice that.
  const auto variance_with = [](double off) {
    RefinementProblem problem = WallProblem(10);
    problem.points.pop_back();
    for (std::size_t i = 0; i < 20; ++i) problem.points[i].point.x() += i % 2 == 0 ? off : -off;
    problem.prior.covariance.diagonal() << 1e4, 1e-10, 1e-10;
    return 1.0 / problem.From(Pose2()).information(0, 0);
  };
  EXPECT_NEAR(variance_with(0.01), 0.01 * 0.01 / 0.455 / 20.0, 1e-7);
  EXPECT_NEAR(variance_with(0.02), 4.0 * variance_with(0.01), 1e-7);
}

TEST(RefineTerms, ResidualIsMeasuredAcrossTheWalls) {
  RefinementProblem problem = WallProblem(2);
  problem.prior.covariance *= 1e-16;  // nothing moves
  const Refinement result = problem.From(Pose2());
  EXPECT_NEAR(result.rms, 0.0, 1e-6);
  for (SurfacePoint& p : problem.points) p.point.x() += 0.03;
  problem.points[0].point.x() -= 0.06;
  EXPECT_NEAR(problem.From(Pose2()).rms, 0.03, 1e-6);
}

/// Points that are still matched in the last iteration, where the pose cannot move.
int Matched(const std::function<void(SurfacePoint*)>& change) {
  RefinementProblem problem = WallProblem(0);
  problem.prior.covariance *= 1e-16;
  change(&problem.points[0]);
  return problem.From(Pose2()).matched;
}

TEST(RefineTerms, GatesPointsAcrossAndAlongTheWall) {
  const double across = RefinementOptions().gate;
  const double along = RefinementOptions().along_gate;
  EXPECT_EQ(Matched([&](SurfacePoint* p) { p->point.x() += across - 0.001; }), 1);
  EXPECT_EQ(Matched([&](SurfacePoint* p) { p->point.x() += across + 0.001; }), 0);
  EXPECT_EQ(Matched([&](SurfacePoint* p) { p->point.x() -= across + 0.001; }), 0);
  EXPECT_EQ(Matched([&](SurfacePoint* p) { p->point.y() += along - 0.001; }), 1);
  EXPECT_EQ(Matched([&](SurfacePoint* p) { p->point.y() += along + 0.001; }), 0);
  EXPECT_EQ(Matched([](SurfacePoint* p) { p->point.x() += 1.0; }), 0);
}

TEST(RefineTerms, LeavesOutTheOtherSideOfAWall) {
  EXPECT_EQ(Matched([](SurfacePoint* p) { p->ray = -p->ray; }), 0);
}

TEST(RefineTerms, ComparesNormalsIfThePointHasOne) {
  const auto turn = [](SurfacePoint* p, double angle) {
    p->normal = {-std::cos(angle), std::sin(angle)};
  };
  EXPECT_EQ(Matched([&](SurfacePoint* p) { turn(p, std::acos(0.71)); }), 1);
  EXPECT_EQ(Matched([&](SurfacePoint* p) { turn(p, std::acos(0.69)); }), 0);
  EXPECT_EQ(Matched([&](SurfacePoint* p) { p->normal = {0.0, 0.0}; }), 1);
}

TEST(RefineTerms, OpensTheGateTwiceAsWideAtFirst) {
  // All points are farther off than the gate of 0.1 m, but the first two steps may bring them in.
  RefinementProblem problem = WallProblem(2);
  problem.prior.map_from_base = {0.19, 0.0, 0.0};
  EXPECT_NEAR(problem.From({0.19, 0.0, 0.0}).map_from_base.x, 0.0, 1e-5);
  problem.prior.map_from_base = {0.21, 0.0, 0.0};
  EXPECT_NEAR(problem.From({0.21, 0.0, 0.0}).map_from_base.x, 0.21, 1e-9);
}

/// One edge 2 m ahead and its landmark, which lies `offset` to the left. Only y can move.
RefinementProblem EdgeProblem(double offset) {
  RefinementProblem problem;
  ModelEdge edge;
  edge.range = 2.0;
  edge.bearing_stddev = 0.01;
  edge.sign = 1;
  edge.weight = 1.0;
  problem.edges = {edge};
  problem.edge_map.Insert({edge}, {0.0, offset, 0.0}, Eigen::Matrix3d::Zero());
  problem.prior.covariance = Eigen::Vector3d(0.01, 0.01, 1e-14).asDiagonal();
  problem.prior.kernel = 1e6;
  problem.options.kernel = 1e6;
  problem.options.edge_correlation = 4.0;
  return problem;
}

TEST(RefineTerms, AnEdgePullsItsLineOfSightToItsLandmark) {
  // 0.02^2 of the image and 0.02^2 of the landmark count 4-fold: 0.0032 against the prior's 0.01.
  const Refinement result = EdgeProblem(0.066).From(Pose2());
  EXPECT_EQ(result.matched_edges, 1);
  EXPECT_NEAR(result.map_from_base.y, 0.066 * 0.01 / 0.0132, 1e-6);
  EXPECT_NEAR(result.map_from_base.x, 0.0, 1e-6);
  EXPECT_NEAR(result.covariance(1, 1), 0.01 * 0.0032 / 0.0132, 1e-9);
  EXPECT_NEAR(result.covariance(0, 0), 0.01, 1e-9);
}

TEST(RefineTerms, AnEdgeOfTheOtherSignPullsNothing) {
  RefinementProblem problem = EdgeProblem(0.066);
  problem.edges[0].sign = -1;
  const Refinement result = problem.From(Pose2());
  EXPECT_EQ(result.matched_edges, 0);
  EXPECT_NEAR(result.map_from_base.y, 0.0, 1e-9);
}

TEST(RefineTerms, AnEdgeTurnsTheRobotAsFarAsItIsAway) {
  // Only the turn can move: until the line of sight meets the landmark at (2, 0.066).
  RefinementProblem problem = EdgeProblem(0.066);
  problem.prior.covariance = Eigen::Vector3d(1e-14, 1e-14, 1e4).asDiagonal();
  EXPECT_NEAR(problem.From(Pose2()).map_from_base.theta, std::atan(0.033), 1e-5);
}

}  // namespace
}  // namespace scan_image_slam
