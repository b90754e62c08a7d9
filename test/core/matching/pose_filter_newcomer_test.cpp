// How edges begin: what is noise must not choose among them.
#include "pose_filter_fixtures.h"

#include <random>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

/// An edge ahead whose wall is seen so slantingly [m/rad].
ModelEdge SlantedEdge(double slant, double bearing = 0.0) {
  ModelEdge edge = EdgeTo({4.0, 0.0}, Pose2());
  edge.bearing = bearing;
  edge.range_by_bearing = std::sqrt(slant * slant - edge.range * edge.range);
  return edge;
}

PoseFilter Started() {
  PoseFilterOptions options = Options();
  options.max_new_slant = 10.0;
  PoseFilter filter(options);
  filter.Start(Pose2());
  return filter;
}

TEST(PoseFilter, AnEdgeBeginsWithTheImageAfterTheOneThatShowsItNearEnough) {
  PoseFilter filter = Started();
  filter.AddEdges({SlantedEdge(11.0)});
  filter.AddEdges({SlantedEdge(11.0)});
  EXPECT_EQ(filter.edges(), 0);
  filter.AddEdges({SlantedEdge(9.0, -0.002)});
  EXPECT_EQ(filter.edges(), 0);
  filter.AddEdges({SlantedEdge(11.0, 0.002)});
  EXPECT_EQ(filter.edges(), 1);
  // It lies where the second image shows it: there it is no surprise, 0.004 rad aside it is one.
  EXPECT_FALSE(filter.Contradicts({SlantedEdge(11.0, 0.002), SlantedEdge(11.0, 0.002)}, 0.0));
  EXPECT_TRUE(filter.Contradicts({SlantedEdge(9.0, -0.002), SlantedEdge(9.0, -0.002)}, 0.0));
}

TEST(PoseFilter, AnEdgeThatIsNotSeenAgainIsNotWaitedFor) {
  PoseFilter filter = Started();
  filter.AddEdges({SlantedEdge(5.0)});
  filter.Predict(Pose2(), Forward(0.3), kNothing * Eigen::Matrix3d::Identity());
  filter.AddEdges({EdgeTo({4.0, 0.0}, filter.map_from_base())});
  EXPECT_EQ(filter.edges(), 0);
  filter.AddEdges({EdgeTo({4.0, 0.0}, filter.map_from_base())});
  EXPECT_EQ(filter.edges(), 1);
}

TEST(PoseFilter, EdgesOfTwoSignsAreMetApart) {
  PoseFilter filter = Started();
  filter.AddEdges({EdgeTo({4.0, 0.0}, Pose2(), 0.0, 1)});
  filter.AddEdges({EdgeTo({4.0, 0.0}, Pose2(), 0.0, -1)});
  EXPECT_EQ(filter.edges(), 0);
}

/// Along a corridor with an edge every half metre on both walls, which the fusion gives as far as
/// they seem to lie within 21 m/rad: the error of the way, in 20 m.
double ErrorOfTheWay(double bearing_noise, std::uint64_t seed) {
  constexpr double kStep = 0.02;
  constexpr double kMostSlant = 21.0;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  PoseFilterOptions options = Options();
  options.edge_correlation = 4.0;
  PoseFilter filter(options);
  filter.Start(Pose2());
  Pose2 truth;
  while (truth.x < 20.0) {
    truth.x += kStep;
    filter.Predict(filter.map_from_base(), Forward(kStep), Noise(0.001, 0.001, 0.002));
    Eigen::Matrix3d information = Noise(1.0, 0.002, 0.001).inverse();
    information(0, 0) = 0.0;
    filter.AddScan({filter.map_from_base().x, truth.y, truth.theta}, information,
                   Eigen::Vector3d::Zero());
    std::vector<ModelEdge> edges;
    for (double x = 0.5 * std::ceil(2.0 * truth.x) + 1.5; x < truth.x + 6.0; x += 0.5) {
      for (const double y : {-1.2, 1.2}) {
        ModelEdge edge = EdgeTo({x, y}, truth);
        edge.bearing += bearing_noise * normal(random);
        PutOnWall(y, truth, &edge);
        if (std::hypot(edge.range, edge.range_by_bearing) <= kMostSlant) edges.push_back(edge);
      }
    }
    filter.AddEdges(edges);
  }
  return filter.map_from_base().x - truth.x;
}

TEST(PoseFilter, TheWayAlongACorridorIsNotShortByTheChoiceOfEdges) {
  constexpr int kRuns = 20;
  constexpr double kNoise = 0.001;  // half of a pixel [rad]
  double sum = 0.0;
  for (int run = 0; run < kRuns; ++run) sum += ErrorOfTheWay(kNoise, run) / kRuns;
  EXPECT_NEAR(sum, 0.0, 0.012);
  EXPECT_NEAR(ErrorOfTheWay(0.0, 0), 0.0, 0.001);
}

}  // namespace
}  // namespace scan_image_slam
