#include "scan_image_slam/core/mapping/graph_ways.h"

#include <cmath>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

constexpr double kForward = 0.01;  // variances of each motion [m^2]
constexpr double kLeft = 0.04;
constexpr double kTurn = 0.0025;  // [rad^2]

GraphConstraint Motion(int from, int to, const Pose2& motion) {
  GraphConstraint constraint;
  constraint.from = from;
  constraint.to = to;
  constraint.from_from_to = motion;
  constraint.information = Eigen::Vector3d(1 / kForward, 1 / kLeft, 1 / kTurn).asDiagonal();
  return constraint;
}

GraphLinks LinksOf(const std::vector<GraphConstraint>& constraints,
                   const std::vector<double>& lengths) {
  GraphLinks links;
  for (int i = 0; i <= static_cast<int>(constraints.size()); ++i) links[i] = {};
  for (int i = 0; i < static_cast<int>(constraints.size()); ++i) {
    links[constraints[i].from].push_back({constraints[i].to, i, lengths[i]});
    links[constraints[i].to].push_back({constraints[i].from, i, lengths[i]});
  }
  return links;
}

// Two motions of 3 m straight ahead: the turn of the first moves the end sideways by 3 m times its
// error.
TEST(GraphWays, AnErrorOfATurnGrowsWithTheWayAfterIt) {
  const std::vector<GraphConstraint> chain = {Motion(0, 1, {3, 0, 0}), Motion(1, 2, {3, 0, 0})};
  const GraphWays ways(LinksOf(chain, {3.0, 3.0}), 2, {0});
  EXPECT_DOUBLE_EQ(ways.Length(0), 6.0);
  const Eigen::Matrix3d covariance = ways.Covariance(chain, 0);
  EXPECT_NEAR(covariance(0, 0), 2 * kForward, 1e-6);
  EXPECT_NEAR(covariance(1, 1), 2 * kLeft + 9 * kTurn, 1e-6);
  EXPECT_NEAR(covariance(2, 2), 2 * kTurn, 1e-6);
  EXPECT_NEAR(covariance(1, 2), 3 * kTurn, 1e-6);
}

// So much for each metre, whatever the constraint says: the turns of both motions, as above, and
// of the first the way of the second.
TEST(GraphWays, DriftGrowsWithTheWay) {
  const std::vector<GraphConstraint> chain = {Motion(0, 1, {3, 0, 0}), Motion(1, 2, {2, 0, 0})};
  const Eigen::Matrix3d drift = Eigen::Vector3d(0.1, 0.2, 0.3).asDiagonal();
  const GraphWays ways(LinksOf(chain, {3.0, 2.0}), 2, {0});
  const Eigen::Matrix3d added = ways.Covariance(chain, 0, drift) - ways.Covariance(chain, 0);
  EXPECT_NEAR(added(0, 0), 5.0 * 0.1, 1e-9);
  EXPECT_NEAR(added(1, 1), 5.0 * 0.2 + 4.0 * 3.0 * 0.3, 1e-9);
  EXPECT_NEAR(added(2, 2), 5.0 * 0.3, 1e-9);
}

// Seen from the other end, the first motion back is the second one: its own turn lies at the far
// end of it, and both motions lie behind the first turn.
TEST(GraphWays, TheWayBackHasTheErrorsOfTheInverseMotions) {
  const std::vector<GraphConstraint> chain = {Motion(0, 1, {3, 0, 0}), Motion(1, 2, {3, 0, 0})};
  const Eigen::Matrix3d covariance =
      GraphWays(LinksOf(chain, {3.0, 3.0}), 0, {2}).Covariance(chain, 2);
  EXPECT_NEAR(covariance(0, 0), 2 * kForward, 1e-6);
  EXPECT_NEAR(covariance(1, 1), 2 * kLeft + (9 + 36) * kTurn, 1e-6);
  EXPECT_NEAR(covariance(2, 2), 2 * kTurn, 1e-6);
}

TEST(GraphWays, AfterAQuarterTurnForwardIsWhatWasLeft) {
  const std::vector<GraphConstraint> chain = {Motion(0, 1, {0, 0, 0}),
                                              Motion(1, 2, {0, 0, M_PI / 2})};
  const Eigen::Matrix3d covariance =
      GraphWays(LinksOf(chain, {1.0, 1.0}), 2, {0}).Covariance(chain, 0);
  EXPECT_NEAR(covariance(0, 0), kLeft + kForward, 1e-6);
  EXPECT_NEAR(covariance(1, 1), kForward + kLeft, 1e-6);
  EXPECT_NEAR(covariance(0, 1), 0.0, 1e-6);
}

// 0 - 1 - 2 - 3 - 4 and a recognised place that joins 0 and 3.
TEST(GraphWays, TakesTheShortestWay) {
  std::vector<GraphConstraint> graph;
  for (int i = 0; i < 4; ++i) graph.push_back(Motion(i, i + 1, {1, 0, 0}));
  graph.push_back(Motion(0, 3, {3, 0, 0}));
  const GraphWays ways(LinksOf(graph, {1.0, 1.0, 1.0, 1.0, 0.5}), 0, {2, 3, 4, 0});
  EXPECT_DOUBLE_EQ(ways.Length(3), 0.5);
  EXPECT_DOUBLE_EQ(ways.Length(2), 1.5);
  EXPECT_DOUBLE_EQ(ways.Length(4), 1.5);
  EXPECT_NEAR(ways.Covariance(graph, 3)(0, 0), kForward, 1e-6);
  EXPECT_NEAR(ways.Covariance(graph, 2)(0, 0), 2 * kForward, 1e-6);
  EXPECT_TRUE(ways.Covariance(graph, 0).isZero());
}

TEST(GraphWays, WhatNoConstraintJoinsIsInfinitelyFar) {
  const GraphLinks links = {{0, {}}, {1, {}}};
  EXPECT_TRUE(std::isinf(GraphWays(links, 0, {1}).Length(1)));
}

TEST(GraphWays, ADirectionThatAConstraintTellsNothingOfIsUnknown) {
  GraphConstraint corridor = Motion(0, 1, {1, 0, 0});
  corridor.information(0, 0) = 0.0;
  const Eigen::Matrix3d covariance =
      GraphWays(LinksOf({corridor}, {1.0}), 1, {0}).Covariance({corridor}, 0);
  EXPECT_GT(covariance(0, 0), 1e5);
  EXPECT_NEAR(covariance(1, 1), kLeft, 1e-6);
}

}  // namespace
}  // namespace scan_image_slam
