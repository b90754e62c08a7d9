#include "scan_image_slam/core/mapping/pose_graph.h"

#include "support_rooms.h"

#include <cmath>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

constexpr double kTenthOfAMillimetre = 1e-4;

GraphConstraint Between(const GraphPoses& nodes, int from, int to, double weight = 1.0) {
  GraphConstraint constraint;
  constraint.from = from;
  constraint.to = to;
  constraint.from_from_to = nodes.at(from).Inverse() * nodes.at(to);
  constraint.information = weight * Eigen::Matrix3d::Identity();
  return constraint;
}

void ExpectNear(const Pose2& a, const Pose2& b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(NormalizeAngle(a.theta - b.theta), 0.0, tolerance);
}

TEST(OptimizeGraph, FindsThePosesThatTheConstraintsAgreeOn) {
  TestRandom random(4);
  GraphPoses truth;
  for (int i = 0; i < 12; ++i) {
    truth[i] = {random.Uniform(-5, 5), random.Uniform(-5, 5), random.Uniform(-M_PI, M_PI)};
  }
  std::vector<GraphConstraint> constraints;
  for (int i = 1; i < 12; ++i) constraints.push_back(Between(truth, i - 1, i, 10.0));
  constraints.push_back(Between(truth, 2, 9));
  constraints.push_back(Between(truth, 11, 0));
  GraphPoses start = truth;
  for (int i = 1; i < 12; ++i) {
    start[i] = start[i] * Pose2{random.Uniform(-0.3, 0.3), random.Uniform(-0.3, 0.3),
                                random.Uniform(-0.2, 0.2)};
  }
  GraphOptions options;
  options.max_iterations = 100;
  GraphPoses found = start;
  OptimizeGraph(constraints, 1, options, &found);
  for (int i = 0; i < 12; ++i) ExpectNear(found[i], truth[i], 1e-3);
}

TEST(OptimizeGraph, SharesAnErrorByTheWeights) {
  // Three nodes on a line, measured 1 m and 1 m apart, but 2.3 m in all: the constraints have
  // weights 1, 1 and 1, so each gives way by a third of 0.3 m.
  const GraphPoses nodes = {{0, {0, 0, 0}}, {1, {1, 0, 0}}, {2, {2, 0, 0}}};
  std::vector<GraphConstraint> constraints = {Between(nodes, 0, 1), Between(nodes, 1, 2),
                                              Between(nodes, 0, 2)};
  constraints[2].from_from_to.x = 2.3;
  GraphPoses found = nodes;
  OptimizeGraph(constraints, 1, GraphOptions(), &found);
  EXPECT_NEAR(found[1].x, 1.1, kTenthOfAMillimetre);
  EXPECT_NEAR(found[2].x, 2.2, kTenthOfAMillimetre);
}

TEST(OptimizeGraph, ADirectionWithoutInformationIsLeftToTheOthers) {
  const GraphPoses nodes = {{0, {0, 0, 0}}, {1, {1, 0, 0}}};
  std::vector<GraphConstraint> constraints = {Between(nodes, 0, 1), Between(nodes, 0, 1)};
  constraints[1].from_from_to = {7.0, 0.4, 0.0};  // says nothing along x
  constraints[1].information = Eigen::Vector3d(0.0, 1.0, 1.0).asDiagonal();
  GraphPoses found = nodes;
  OptimizeGraph(constraints, 1, GraphOptions(), &found);
  EXPECT_NEAR(found[1].x, 1.0, 1e-3);
  EXPECT_NEAR(found[1].y, 0.2, 1e-3);
}

TEST(OptimizeGraph, NodesBeforeTheFirstFreeOneStay) {
  const GraphPoses nodes = {{0, {0, 0, 0}}, {1, {1, 0, 0}}, {2, {2, 0, 0}}, {3, {3, 0, 0}}};
  std::vector<GraphConstraint> constraints = {Between(nodes, 0, 1), Between(nodes, 1, 2),
                                              Between(nodes, 2, 3), Between(nodes, 0, 3)};
  constraints[3].from_from_to.x = 3.6;
  GraphPoses found = nodes;
  OptimizeGraph(constraints, 2, GraphOptions(), &found);
  EXPECT_EQ(found[1].x, 1.0);
  EXPECT_NEAR(found[2].x, 2.2, kTenthOfAMillimetre);
  EXPECT_NEAR(found[3].x, 3.4, kTenthOfAMillimetre);
}

TEST(OptimizeGraph, NumbersMayBeMissing) {
  const GraphPoses nodes = {{0, {0, 0, 0}}, {7, {1, 0, 0}}, {1000, {2, 0, 0}}};
  std::vector<GraphConstraint> constraints = {Between(nodes, 0, 7), Between(nodes, 7, 1000)};
  constraints[1].from_from_to.x = 1.5;
  GraphPoses found = nodes;
  OptimizeGraph(constraints, 1, GraphOptions(), &found);
  ASSERT_EQ(found.size(), 3U);
  EXPECT_NEAR(found[7].x, 1.0, kTenthOfAMillimetre);
  EXPECT_NEAR(found[1000].x, 2.5, kTenthOfAMillimetre);
}

TEST(OptimizeGraph, AWrongPlaceAmongManyRightOnesIsOverruled) {
  GraphPoses nodes;
  for (int i = 0; i < 10; ++i) nodes[i] = {0.5 * i, 0.0, 0.0};
  std::vector<GraphConstraint> constraints;
  for (int i = 1; i < 10; ++i) constraints.push_back(Between(nodes, i - 1, i, 1e4));
  for (int i = 5; i < 10; ++i) {
    constraints.push_back(Between(nodes, 0, i, 1e4));
    constraints.back().robust = true;
  }
  GraphConstraint wrong = Between(nodes, 0, 9, 1e4);
  wrong.from_from_to.y = 3.0;
  wrong.robust = true;
  constraints.push_back(wrong);
  GraphPoses found = nodes;
  OptimizeGraph(constraints, 1, GraphOptions(), &found);
  EXPECT_NEAR(found[9].y, 0.0, 0.02);
  EXPECT_GT(SquaredResidual(wrong, found), 1e4 * 2.9 * 2.9);
}

TEST(SquaredResidual, IsMeasuredInTheFrameOfTheMeasuredPose) {
  // Node 1 was measured 1 m ahead, turned left by 90 degrees; it lies 0.2 m to the left of that,
  // which is ahead for it: the first weight counts.
  GraphConstraint constraint;
  constraint.from = 0;
  constraint.to = 1;
  constraint.from_from_to = {1.0, 0.0, M_PI_2};
  constraint.information = Eigen::Vector3d(100.0, 1.0, 1.0).asDiagonal();
  EXPECT_NEAR(SquaredResidual(constraint, {{0, {0, 0, 0}}, {1, {1.0, 0.2, M_PI_2}}}), 100.0 * 0.04,
              1e-9);
}

// Two motions of 3 m straight ahead: the turn of the first moves the end sideways by 3 m times its
// error.
TEST(PoseGraph, TwoMotionsInARowHaveTheErrorsOfBoth) {
  constexpr double kForward = 0.01;
  constexpr double kLeft = 0.04;
  constexpr double kTurn = 0.0025;
  GraphConstraint first;
  first.from = 4;
  first.to = 5;
  first.from_from_to = {3.0, 0.0, 0.0};
  first.information = Eigen::Vector3d(1 / kForward, 1 / kLeft, 1 / kTurn).asDiagonal();
  GraphConstraint second = first;
  second.from = 5;
  second.to = 8;
  const GraphConstraint both = Chained(first, second);
  EXPECT_EQ(both.from, 4);
  EXPECT_EQ(both.to, 8);
  EXPECT_DOUBLE_EQ(both.from_from_to.x, 6.0);
  EXPECT_FALSE(both.robust);
  first.robust = true;
  EXPECT_TRUE(Chained(first, second).robust);
  const Eigen::Matrix3d covariance = both.information.inverse();
  EXPECT_NEAR(covariance(0, 0), 2 * kForward, 1e-9);
  EXPECT_NEAR(covariance(1, 1), 2 * kLeft + 9 * kTurn, 1e-9);
  EXPECT_NEAR(covariance(2, 2), 2 * kTurn, 1e-9);
  EXPECT_NEAR(covariance(1, 2), 3 * kTurn, 1e-9);
}

}  // namespace
}  // namespace scan_image_slam
