#include "scan_image_slam/core/matching/refinement.h"

#include "core/matching/refinement_fixtures.h"
#include "support_rooms.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

void ExpectPose(const Pose2& pose, const Pose2& expected, double distance, double angle) {
  const Pose2 error = expected.Inverse() * pose;
  EXPECT_LT(error.translation().norm(), distance);
  EXPECT_LT(std::abs(error.theta), angle);
}

const Pose2 kFirst{0.1, 0.2, -0.3};
const Pose2 kSecond{0.22, 0.11, -0.24};

/// Starts up to 0.07 m and 1.1 degrees off, on every side.
const std::vector<Pose2> kOffsets{{0, 0, 0},           {0.05, 0.05, 0.02},  {-0.05, 0.05, -0.02},
                                  {0.05, -0.05, 0.02}, {-0.05, -0.05, 0.0}, {0.0, 0.07, -0.02}};

/// A map of a scan from `first` that was placed at `map_from_first`, and a scan from `second`.
RefinementProblem TwoScans(const Pose2& first, const Pose2& second, const Pose2& map_from_first) {
  RefinementProblem problem;
  problem.map.Insert(SurfaceSeen(SeparateWalls(), first), map_from_first);
  problem.points = SurfaceSeen(SeparateWalls(), second);
  return problem;
}

void ExpectRegistration(const Pose2& first, const Pose2& second, const Pose2& map_from_first) {
  const Pose2 expected = map_from_first * (first.Inverse() * second);
  RefinementProblem problem = TwoScans(first, second, map_from_first);
  problem.prior.map_from_base = expected * Pose2{0.01, -0.02, 0.01};
  for (const Pose2& offset : kOffsets) {
    const Refinement result = problem.From(expected * offset);
    ExpectPose(result.map_from_base, expected, 1e-6, 1e-6);
    EXPECT_GT(result.matched, 0.9 * static_cast<double>(problem.points.size()));
    EXPECT_LT(result.rms, 1e-6);
    EXPECT_FALSE(result.degenerate);
  }
}

TEST(Refine, FindsAMotionExactly) { ExpectRegistration(kFirst, kSecond, Pose2()); }

TEST(Refine, FindsItsInverse) { ExpectRegistration(kSecond, kFirst, Pose2()); }

TEST(Refine, FindsItWhereverTheMapIs) {
  ExpectRegistration(kFirst, kSecond, {2.0, -3.0, 2.5});
  ExpectRegistration(kFirst, kSecond, {-1.5, 0.7, -3.0});
}

TEST(Refine, FindsItFromTheFrameOfAnotherBase) {
  // Both scans told in a base that is mounted elsewhere: the motion is told there, too.
  const Pose2 base_from_other{0.3, -0.2, 0.7};
  const Pose2 other_from_base = base_from_other.Inverse();
  const auto moved = [&](std::vector<SurfacePoint> points) {
    const RigidTransform2 transform(other_from_base);
    for (SurfacePoint& p : points) {
      p.point = transform * p.point;
      p.ray = transform.Rotate(p.ray);
      p.normal = transform.Rotate(p.normal);
    }
    return points;
  };
  RefinementProblem problem;
  problem.map.Insert(moved(SurfaceSeen(SeparateWalls(), kFirst)), Pose2());
  problem.points = moved(SurfaceSeen(SeparateWalls(), kSecond));
  const Pose2 expected = other_from_base * (kFirst.Inverse() * kSecond) * base_from_other;
  problem.prior.map_from_base = expected;
  ExpectPose(problem.From(expected * Pose2{0.03, 0.02, -0.02}).map_from_base, expected, 1e-6, 1e-6);
}

TEST(Refine, StaysAtTheTruth) {
  RefinementProblem problem = TwoScans(kFirst, kFirst, kFirst);
  problem.prior.map_from_base = kFirst;
  ExpectPose(problem.From(kFirst).map_from_base, kFirst, 1e-7, 1e-7);
}

TEST(Refine, CountsTheTurnTheShortWayRound) {
  const Pose2 back{0.0, 0.0, M_PI - 0.01};
  const Pose2 across{0.0, 0.0, -M_PI + 0.01};
  ExpectRegistration(back, across, back);
}

TEST(Refine, IsNotDrawnByAFifthOfOutliers) {
  // People stand before the walls: one beam in five ends somewhere on its way. Such points lie far
  // from the walls, or near them by chance, which the kernel has to bear: less than a tenth of the
  // laser's own noise.
  TestRandom random(6);
  RefinementProblem problem = TwoScans(kFirst, kSecond, kFirst);
  for (std::size_t i = 0; i < problem.points.size(); i += 5) {
    SurfacePoint& p = problem.points[i];
    const double fraction = random.Uniform(0.2, 0.99);
    p.point *= fraction;
    p.range *= fraction;
  }
  problem.prior.map_from_base = kSecond;
  for (const Pose2& offset : kOffsets) {
    ExpectPose(problem.From(kSecond * offset).map_from_base, kSecond, 0.002, 0.001);
  }
}

TEST(Refine, WeighsNoiseDown) {
  // Hundreds of points with 20 mm of noise, ten of which err together: 20 mm / sqrt(300 / 10).
  TestRandom random(7);
  TestLaser laser;
  laser.range_stddev = 0.02;
  RefinementProblem problem = TwoScans(kFirst, kSecond, kFirst);
  problem.prior.map_from_base = kSecond;
  for (int i = 0; i < 20; ++i) {
    problem.points = SurfaceSeen(SeparateWalls(), kSecond, laser, &random);
    EXPECT_GT(problem.points.size(), 300u);
    ExpectPose(problem.From(kSecond * kOffsets[i % 6]).map_from_base, kSecond,
               3.0 * 0.02 / std::sqrt(30.0), 0.005);
  }
}

TEST(Refine, KeepsThePriorWithoutPoints) {
  RefinementProblem problem;
  problem.prior.map_from_base = {1.0, 2.0, 0.5};
  problem.prior.covariance = Eigen::Vector3d(0.04, 0.01, 0.0025).asDiagonal();
  const Refinement result = problem.From({1.1, 2.0, 0.45});
  ExpectPose(result.map_from_base, problem.prior.map_from_base, 1e-4, 1e-4);
  EXPECT_NEAR((result.covariance - problem.prior.covariance).norm(), 0.0, 1e-6);
  EXPECT_EQ(result.matched, 0);
  EXPECT_EQ(result.rms, 0.0);
}

TEST(Refine, LeavesTheStartAloneWithoutIterations) {
  RefinementProblem problem = TwoScans(kFirst, kSecond, kFirst);
  problem.options.max_iterations = 0;
  problem.prior.covariance = Eigen::Matrix3d::Identity() * 0.25;
  const Pose2 start = kSecond * Pose2{0.05, 0.0, 0.0};
  const Refinement result = problem.From(start);
  EXPECT_EQ(result.map_from_base.x, start.x);
  EXPECT_EQ(result.map_from_base.theta, start.theta);
  EXPECT_EQ(result.covariance(0, 0), 0.25);
}

}  // namespace
}  // namespace scan_image_slam
