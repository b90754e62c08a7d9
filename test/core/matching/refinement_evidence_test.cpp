// What a refinement says of itself: directions without information, and its covariance.
#include "core/matching/refinement_fixtures.h"
#include "scan_image_slam/core/matching/refinement.h"
#include "support_rooms.h"

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

const Pose2 kOrigin;

/// A scan of the plain corridor from `pose`, against a map of it seen from the origin. The prior is
/// sure to 0.1 m and 0.05 rad.
RefinementProblem CorridorProblem(const Pose2& pose, TestRandom* random = nullptr) {
  TestLaser laser;
  laser.max_range = 10.0;
  laser.range_stddev = 0.01;
  RefinementProblem problem;
  problem.map.Insert(SurfaceSeen(PlainCorridor(), kOrigin, laser, random), kOrigin);
  problem.points = SurfaceSeen(PlainCorridor(), pose, laser, random);
  problem.prior.covariance = Eigen::Vector3d(0.01, 0.01, 0.0025).asDiagonal();
  return problem;
}

double AngleFromAxis(double direction, double axis) {
  const double angle = std::abs(NormalizeAngle(direction - axis));
  return std::min(angle, M_PI - angle);
}

TEST(RefineEvidence, KeepsThePriorAlongAPlainCorridor) {
  const Pose2 pose{0.3, 0.05, 0.02};
  RefinementProblem problem = CorridorProblem(pose);
  problem.prior.map_from_base = {0.25, 0.0, 0.0};
  const Refinement result = problem.From(problem.prior.map_from_base);
  EXPECT_NEAR(result.map_from_base.x, 0.25, 0.05 * 0.02 + 1e-4);  // sideways, but of a turned base
  EXPECT_NEAR(result.map_from_base.y, 0.05, 1e-4);
  EXPECT_NEAR(result.map_from_base.theta, 0.02, 1e-4);
}

TEST(RefineEvidence, SaysWhichDirectionACorridorLeavesOpen) {
  for (const double turn : {0.0, 0.7, -1.2}) {
    const Pose2 pose{0.3, 0.1, turn};
    RefinementProblem problem = CorridorProblem(pose);
    problem.prior.map_from_base = pose;
    const Refinement result = problem.From(pose);
    EXPECT_TRUE(result.degenerate);
    EXPECT_LT(AngleFromAxis(result.degenerate_direction, -turn), 0.01);  // told in the base frame
  }
}

TEST(RefineEvidence, LeavesTheCovarianceOfThePriorAlongACorridor) {
  RefinementProblem problem = CorridorProblem(kOrigin);
  problem.prior.map_from_base = kOrigin;
  const Eigen::Matrix3d covariance = problem.From(kOrigin).covariance;
  EXPECT_NEAR(covariance(0, 0), 0.01, 1e-5);
  EXPECT_GT(covariance(0, 0), 10.0 * covariance(1, 1));
}

TEST(RefineEvidence, DoesNotTakeNoiseForInformationAlongACorridor) {
  // The normals of a noisy corridor point a little forward and back, which must not move the robot.
  TestRandom random(8);
  for (int i = 0; i < 20; ++i) {
    RefinementProblem problem = CorridorProblem({0.3, 0.0, 0.0}, &random);
    problem.prior.map_from_base = {0.25, 0.0, 0.0};
    const Refinement result = problem.From(problem.prior.map_from_base);
    EXPECT_TRUE(result.degenerate);
    EXPECT_LT(AngleFromAxis(result.degenerate_direction, 0.0), 0.05);
    EXPECT_NEAR(result.map_from_base.x, 0.25, 0.002);
    EXPECT_NEAR(result.map_from_base.y, 0.0, 0.01);
  }
}

TEST(RefineEvidence, IsNotDegenerateWhereTheCorridorEnds) {
  const Room end = PlainCorridor() + Room{{{4.0, -1.0}, {4.0, 1.0}}};
  RefinementProblem problem;
  problem.map.Insert(SurfaceSeen(end, kOrigin), kOrigin);
  problem.points = SurfaceSeen(end, {0.3, 0.0, 0.0});
  problem.prior.map_from_base = {0.25, 0.0, 0.0};
  const Refinement result = problem.From(problem.prior.map_from_base);
  EXPECT_FALSE(result.degenerate);
  EXPECT_NEAR(result.map_from_base.x, 0.3, 0.001);
}

TEST(RefineEvidence, AFewPointsOnAFarEndTellTheWay) {
  // 9 of 720 beams meet the end of a corridor that is 25 m off.
  const Room end = PlainCorridor() + Room{{{25.0, -1.0}, {25.0, 1.0}}};
  RefinementProblem problem;
  problem.map.Insert(SurfaceSeen(end, kOrigin), kOrigin);
  problem.points = SurfaceSeen(end, {0.03, 0.0, 0.0});
  const Refinement result = problem.From(kOrigin);
  EXPECT_TRUE(result.weak);
  EXPECT_FALSE(result.degenerate);
  EXPECT_NEAR(result.map_from_base.x, 0.03, 0.001);
  EXPECT_GT(result.covariance(0, 0), 10.0 * result.covariance(1, 1));
}

/// A thing that faces along the corridor, 3 m ahead: points at these places across it [m].
Refinement SeenInCorridor(const std::vector<double>& places) {
  RefinementProblem problem = CorridorProblem(kOrigin);
  std::vector<SurfacePoint> facing;
  facing.reserve(places.size());
  for (const double y : places) facing.push_back(PointAhead(3.0, y));
  problem.map.Insert(facing, kOrigin);
  problem.points.insert(problem.points.end(), facing.begin(), facing.end());
  return problem.From({0.02, 0.0, 0.0});
}

TEST(RefineEvidence, AWallThatFacesTheWayTellsOfItUnlessPeopleAreAsWide) {
  EXPECT_FALSE(SeenInCorridor({-0.4, -0.2, 0.0, 0.2, 0.41}).degenerate);
  EXPECT_TRUE(SeenInCorridor({-0.4, -0.13, 0.14, 0.41}).degenerate);    // four points
  EXPECT_TRUE(SeenInCorridor({-0.3, -0.1, 0.0, 0.1, 0.3}).degenerate);  // no wider than people
  EXPECT_TRUE(SeenInCorridor({-0.5, -0.4, -0.3, 0.1, 0.3, 0.5}).degenerate);  // two of them
}

TEST(RefineEvidence, WhatTellsNothingOfTheWayGivesNoInformationOfIt) {
  EXPECT_LT(SeenInCorridor({-0.3, -0.1, 0.0, 0.1, 0.3}).information(0, 0), 1.0);
  EXPECT_GT(SeenInCorridor({-0.4, -0.2, 0.0, 0.2, 0.41}).information(0, 0), 100.0);
}

TEST(RefineEvidence, ComparesTheAxesByTheGivenRatio) {
  // 36 times as many points look along x as along y.
  RefinementProblem problem;
  problem.noise = {0.01, 0.0};
  problem.map = LocalMap(LocalMapOptions(), problem.noise);
  std::vector<SurfacePoint> points;
  for (int i = 0; i < 36; ++i) points.push_back(PointAhead(2.0, 0.1 * (i - 17.5)));
  SurfacePoint left = PointAhead(0.0, 2.0);
  left.ray = {0.0, 1.0};
  left.normal = {0.0, -1.0};
  left.range = 2.0;
  points.push_back(left);
  problem.map.Insert(points, kOrigin);
  problem.points = points;
  problem.options.degenerate_ratio = 1.0 / 35.0;
  EXPECT_TRUE(problem.From(kOrigin).degenerate);
  EXPECT_LT(AngleFromAxis(problem.From(kOrigin).degenerate_direction, M_PI / 2.0), 1e-3);
  problem.options.degenerate_ratio = 1.0 / 37.0;
  EXPECT_FALSE(problem.From(kOrigin).degenerate);
}

/// Edges on both walls, seen from the origin before and from `pose` now.
RefinementProblem CorridorWithEdges(const Pose2& pose) {
  RefinementProblem problem = CorridorProblem(pose);
  const std::vector<RoomEdge> edges{{{1.0, 1.0}, 1},  {{1.9, 1.0}, -1},  {{-1.2, 1.0}, 1},
                                    {{0.6, -1.0}, 1}, {{1.5, -1.0}, -1}, {{-0.8, -1.0}, -1}};
  problem.edge_map.Insert(EdgesSeen(edges, kOrigin, 0.001), kOrigin, Eigen::Matrix3d::Zero());
  problem.edges = EdgesSeen(edges, pose, 0.001);
  return problem;
}

TEST(RefineEvidence, EdgesTellTheWayAlongACorridor) {
  const Pose2 pose{0.3, 0.05, 0.02};
  RefinementProblem problem = CorridorWithEdges(pose);
  problem.prior.map_from_base = pose * Pose2{-0.05, 0.0, 0.0};
  const Refinement result = problem.From(problem.prior.map_from_base);
  EXPECT_EQ(result.matched_edges, 6);
  EXPECT_LT(result.covariance(0, 0), 0.1 * 0.01);
  // What is left of the prior's error is its share in the covariance, and more is not allowed.
  const double share = result.covariance(0, 0) / 0.01;
  EXPECT_NEAR(result.map_from_base.x, 0.3, 0.05 * share + 1e-3);
  EXPECT_NEAR(result.map_from_base.y, 0.05, 1e-3);
}

/// Means over many scans with noise.
struct MonteCarlo {
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();     ///< of the errors
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< as reported
  double normalised = 0.0;                               ///< e^T covariance^-1 e
};

constexpr int kRuns = 400;

/// Refines scans of independent noise against a map of next to none, without a prior.
MonteCarlo RunMany(const RefinementOptions& options) {
  TestRandom random(9);
  TestLaser laser;
  laser.range_stddev = 0.02;
  const Pose2 truth{0.1, 0.2, -0.3};
  RefinementProblem problem;
  problem.options = options;
  problem.noise = {0.02, 0.0};
  problem.map = LocalMap(LocalMapOptions(), {1e-4, 0.0});
  problem.map.Insert(SurfaceSeen(SeparateWalls(), truth), truth);
  problem.prior.map_from_base = truth;
  MonteCarlo mean;
  for (int i = 0; i < kRuns; ++i) {
    problem.points = SurfaceSeen(SeparateWalls(), truth, laser, &random);
    const Refinement result = problem.From(truth);
    const Pose2 error = truth.Inverse() * result.map_from_base;
    const Eigen::Vector3d e(error.x, error.y, error.theta);
    mean.squares += e * e.transpose() / kRuns;
    mean.covariance += result.covariance / kRuns;
    mean.normalised += e.dot(result.covariance.inverse() * e) / kRuns;
  }
  return mean;
}

TEST(RefineEvidence, CovarianceIsThatOfTheErrors) {
  // With a model as smooth as it is, and points that err alone, the reported covariance is that of
  // the errors, times `correlation`. Means of 400 squares are off by 3 * sqrt(2 / 400) = 0.21 at
  // most, that of the normalised error by 3 * sqrt(6 / 400) = 0.37.
  RefinementOptions options;
  options.model_stddev = 1e-4;
  options.kernel = 100.0;
  for (const double correlation : {1.0, 10.0}) {
    options.correlation = correlation;
    const MonteCarlo mean = RunMany(options);
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(mean.squares(i, i) / mean.covariance(i, i) * correlation, 1.0, 0.21) << i;
    }
    EXPECT_NEAR(mean.normalised * correlation, 3.0, 0.37);
  }
}

TEST(RefineEvidence, CovarianceIsCautiousByDefault) {
  // Points are independent here, so `correlation` makes the covariance ten times too large; the
  // roughness of the model, as large as the noise, and the kernel at most double it twice.
  const RefinementOptions options;
  const MonteCarlo mean = RunMany(options);
  for (int i = 0; i < 3; ++i) {
    const double ratio = mean.covariance(i, i) / mean.squares(i, i);
    EXPECT_GT(ratio, options.correlation * 0.79);
    EXPECT_LT(ratio, options.correlation * 4.0 * 1.27);
  }
}

struct NamedOption {
  const char* name;
  double RefinementOptions::*field;
};

std::string Complaint(const RefinementOptions& options) {
  try {
    options.Validate();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(RefinementOptions, AreRefusedByName) {
  for (const NamedOption& named : {NamedOption{"gate", &RefinementOptions::gate},
                                   NamedOption{"along_gate", &RefinementOptions::along_gate},
                                   NamedOption{"model_stddev", &RefinementOptions::model_stddev},
                                   NamedOption{"kernel", &RefinementOptions::kernel},
                                   NamedOption{"correlation", &RefinementOptions::correlation}}) {
    for (const double wrong : {0.0, -1.0, std::nan("")}) {
      RefinementOptions options;
      options.*named.field = wrong;
      EXPECT_EQ(Complaint(options).find(named.name), 0u) << named.name;
    }
  }
  RefinementOptions options;
  options.max_iterations = -1;
  EXPECT_EQ(Complaint(options).find("max_iterations"), 0u);
  EXPECT_EQ(Complaint(RefinementOptions()), "");
}

TEST(RefinementOptions, AreRefusedByNameInEachField) {
  for (const NamedOption& named :
       {NamedOption{"edge_correlation", &RefinementOptions::edge_correlation},
        NamedOption{"min_normal_cosine", &RefinementOptions::min_normal_cosine},
        NamedOption{"degenerate_ratio", &RefinementOptions::degenerate_ratio}}) {
    for (const double wrong : {-2.0, std::nan("")}) {
      RefinementOptions options;
      options.*named.field = wrong;
      EXPECT_EQ(Complaint(options).find(named.name), 0u) << named.name;
    }
  }
}

}  // namespace
}  // namespace scan_image_slam
