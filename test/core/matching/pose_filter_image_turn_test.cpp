// The turn between image and scan, which is not known exactly.
#include "pose_filter_fixtures.h"

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

/// Of a base at the origin.
std::vector<ModelEdge> EdgesAround() {
  std::vector<ModelEdge> edges;
  for (const Eigen::Vector2d& place :
       {Eigen::Vector2d(2.0, 1.0), {3.0, 0.0}, {2.5, -1.0}, {1.5, 2.0}, {1.0, -2.0}}) {
    edges.push_back(EdgeTo(place, Pose2()));
  }
  return edges;
}

TEST(PoseFilter, ATurnOfAllEdgesAlikeIsNotTakenForOneOfTheBaseIfTheImageIsOfAnotherTime) {
  constexpr double kTurn = 0.0005;  // [rad]
  const auto turn_of_base = [&](double time_offset) {
    PoseFilter filter(Options());
    filter.Start(Pose2());
    std::vector<ModelEdge> edges = EdgesAround();
    Show(edges, &filter);
    filter.Predict(Pose2(), Forward(0.0), Noise(1e-5, 1e-5, 0.001));
    for (ModelEdge& edge : edges) {
      edge.time_offset = time_offset;
      edge.bearing += kTurn;
    }
    filter.AddEdges(edges);
    return filter.map_from_base().theta;
  };
  EXPECT_LT(turn_of_base(0.0), -0.8 * kTurn);
  EXPECT_GT(turn_of_base(-0.2), -0.2 * kTurn);
}

TEST(PoseFilter, EachImageIsTurnedInItsOwnWay) {
  constexpr double kTurn = 0.0005;  // [rad]
  PoseFilter filter(Options());
  filter.Start(Pose2());
  std::vector<ModelEdge> edges = EdgesAround();
  Show(edges, &filter);
  for (ModelEdge& edge : edges) edge.time_offset = -0.2;
  filter.Predict(Pose2(), Forward(0.0), Noise(1e-4, 1e-4, 1e-4));
  for (int image = 0; image < 20; ++image) {
    std::vector<ModelEdge> seen = edges;
    const double turn = image % 2 == 0 ? kTurn : -kTurn;
    for (ModelEdge& edge : seen) edge.bearing += turn;
    for (const EdgeMatch& match : filter.AddEdges(seen)) {
      EXPECT_EQ(match.use, EdgeUse::kMatched) << image;
    }
    EXPECT_NEAR(filter.map_from_base().theta, 0.0, 0.2 * kTurn) << image;
  }
  const std::vector<EdgeMatch> last = filter.AddEdges(edges);
  EXPECT_NEAR(last.front().residual, 0.0, 0.3 * kTurn);
}

/// By the first image alone a turn of the base can't be told from one between image and scan. The
/// second has no such turn, and sees where the base is.
TEST(PoseFilter, WhatWasSaidOfTheTurnOfOneImageIsNotBelievedOfTheNext) {
  constexpr double kTurn = 0.002;  // [rad]
  PoseFilterOptions options = Options();
  options.camera_yaw_stddev = 0.0;
  PoseFilter filter(options);
  filter.Start(Pose2());
  const std::vector<ModelEdge> edges = EdgesAround();
  Show(edges, &filter);
  filter.Predict(Pose2(), Forward(0.0), Noise(1e-5, 1e-5, 0.003));
  std::vector<ModelEdge> turned = edges;
  for (ModelEdge& edge : turned) {
    edge.time_offset = -0.2;
    edge.bearing += kTurn;
  }
  filter.AddEdges(turned);
  EXPECT_LT(filter.map_from_base().theta, -0.2 * kTurn);
  filter.AddEdges(edges);
  EXPECT_NEAR(filter.map_from_base().theta, 0.0, 0.05 * kTurn);
}

}  // namespace
}  // namespace scan_image_slam
