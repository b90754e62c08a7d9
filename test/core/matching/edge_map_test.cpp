#include "scan_image_slam/core/matching/edge_map.h"

#include "support_rooms.h"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

const Eigen::Matrix3d kExact = Eigen::Matrix3d::Zero();

/// An edge straight ahead, `range` away, unless `bearing` says otherwise.
ModelEdge EdgeAt(double range, double bearing = 0.0, int sign = 1, double weight = 1.0) {
  ModelEdge edge;
  edge.range = range;
  edge.range_stddev = 0.04;
  edge.bearing = bearing;
  edge.bearing_stddev = 0.025;
  edge.sign = sign;
  edge.weight = weight;
  return edge;
}

/// A map with one landmark at (2, 0), seen along x.
EdgeMap MapWithOneLandmark(int sign = 1) {
  EdgeMap map{EdgeMapOptions()};
  map.Insert({EdgeAt(2.0, 0.0, sign)}, Pose2(), kExact);
  return map;
}

/// Looks along y from 2 m below (x, 0).
Pose2 PoseBelow(double x) { return {x, -2.0, M_PI / 2.0}; }

TEST(DistinctEdges, LeavesOutTheFarAndTheWeak) {
  EdgeMapOptions options;
  options.max_range = 5.0;
  options.min_weight = 0.25;
  const auto distinct =
      DistinctEdges({EdgeAt(5.1), EdgeAt(5.0, 0.5), EdgeAt(3.0, 1.0, 1, 0.24)}, options);
  ASSERT_EQ(distinct.size(), 1u);
  EXPECT_EQ(distinct[0].range, 5.0);
  EXPECT_EQ(DistinctEdges({EdgeAt(3.0, 1.0, 1, 0.25)}, options).size(), 1u);
}

TEST(DistinctEdges, DropsBothOfTwoRivals) {
  // 0.14 m and 0.16 m apart at 2 m.
  EXPECT_TRUE(DistinctEdges({EdgeAt(2.0), EdgeAt(2.0, 0.07)}, EdgeMapOptions()).empty());
  EXPECT_EQ(DistinctEdges({EdgeAt(2.0), EdgeAt(2.0, 0.08)}, EdgeMapOptions()).size(), 2u);
}

TEST(DistinctEdges, KeepsTheOneThatIsMoreThanTwiceAsStrong) {
  const auto distinct =
      DistinctEdges({EdgeAt(2.0, 0.0, 1, 0.9), EdgeAt(2.0, 0.05, 1, 0.44)}, EdgeMapOptions());
  ASSERT_EQ(distinct.size(), 1u);
  EXPECT_EQ(distinct[0].weight, 0.9);
  EXPECT_TRUE(
      DistinctEdges({EdgeAt(2.0, 0.0, 1, 0.9), EdgeAt(2.0, 0.05, 1, 0.46)}, EdgeMapOptions())
          .empty());
}

TEST(DistinctEdges, TellsNeighboursOfTheOtherSignApart) {
  EXPECT_EQ(DistinctEdges({EdgeAt(2.0, 0.0, 1), EdgeAt(2.0, 0.02, -1)}, EdgeMapOptions()).size(),
            2u);
}

TEST(EdgeMap, StartsALandmarkWithTheUncertaintyOfItsView) {
  // Along the ray 0.04 m of the range and 0.03 m of the surface, across it 0.025 rad at 2 m.
  const EdgeMap map = MapWithOneLandmark(-1);
  ASSERT_EQ(map.landmarks().size(), 1u);
  const EdgeLandmark& landmark = map.landmarks()[0];
  EXPECT_NEAR((landmark.position - Eigen::Vector2d(2.0, 0.0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR(landmark.covariance(0, 0), 0.0025, 1e-12);
  EXPECT_NEAR(landmark.covariance(1, 1), 0.0025, 1e-12);
  EXPECT_EQ(landmark.sign, -1);
  EXPECT_EQ(landmark.hits, 1);
}

TEST(EdgeMap, TurnsThatUncertaintyIntoTheMap) {
  ModelEdge edge = EdgeAt(2.0, -0.3);
  edge.bearing_stddev = 0.001;
  EdgeMap map{EdgeMapOptions()};
  map.Insert({edge}, {1.0, 2.0, 0.3 + M_PI / 2.0}, kExact);  // its ray runs along the map's y
  const EdgeLandmark& landmark = map.landmarks()[0];
  EXPECT_NEAR((landmark.position - Eigen::Vector2d(1.0, 4.0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR(landmark.covariance(0, 0), 4e-6, 1e-12);
  EXPECT_NEAR(landmark.covariance(1, 1), 0.0025, 1e-12);
  EXPECT_NEAR(landmark.covariance(0, 1), 0.0, 1e-12);
}

TEST(EdgeMap, CountsFromTheCamera) {
  ModelEdge edge = EdgeAt(2.0);
  edge.camera = {0.5, 0.1};
  EdgeMap map{EdgeMapOptions()};
  map.Insert({edge}, Pose2(), kExact);
  EXPECT_NEAR((map.landmarks()[0].position - Eigen::Vector2d(2.5, 0.1)).norm(), 0.0, 1e-12);
}

TEST(EdgeMap, FindsALandmarkOfTheSameSignOnly) {
  const EdgeMap map = MapWithOneLandmark(1);
  const RigidTransform2 here{Pose2()};
  EXPECT_EQ(map.Find(EdgeAt(2.0, 0.0, 1), here), &map.landmarks()[0]);
  EXPECT_EQ(map.Find(EdgeAt(2.0, 0.0, -1), here), nullptr);
}

TEST(EdgeMap, FindsALandmarkWithinTheGateOnly) {
  const EdgeMap map = MapWithOneLandmark();
  const auto found_from = [&](double x) {
    return map.Find(EdgeAt(2.0), RigidTransform2(PoseBelow(x))) != nullptr;
  };
  EXPECT_TRUE(found_from(2.099));
  EXPECT_FALSE(found_from(2.101));
  EXPECT_TRUE(found_from(1.901));
  EXPECT_FALSE(found_from(1.899));
}

TEST(EdgeMap, UpdatesALandmarkByHand) {
  // Seen along y, 0.05 m off: the landmark and the image are equally sure of x (0.05 m), so it
  // moves half way and its variance halves; of y the image says nothing.
  EdgeMap map = MapWithOneLandmark();
  map.Insert({EdgeAt(2.0)}, PoseBelow(2.05), kExact);
  ASSERT_EQ(map.landmarks().size(), 1u);
  const EdgeLandmark& landmark = map.landmarks()[0];
  EXPECT_NEAR(landmark.position.x(), 2.025, 1e-12);
  EXPECT_NEAR(landmark.position.y(), 0.0, 1e-12);
  EXPECT_NEAR(landmark.covariance(0, 0), 0.00125, 1e-12);
  EXPECT_NEAR(landmark.covariance(1, 1), 0.0025, 1e-12);
  EXPECT_NEAR(landmark.covariance(0, 1), 0.0, 1e-12);
  EXPECT_EQ(landmark.hits, 2);
}

TEST(EdgeMap, TrustsAnImageLessWhereThePoseIsUnsure) {
  // Seen from below, the pose's error to its left and 2 m times that of its turn count, and the one
  // forward does not: 0.0025 + 0.0009 + 4 * 0.0004 = 0.005 against the landmark's 0.0025.
  EdgeMap map = MapWithOneLandmark();
  const Eigen::Matrix3d covariance = Eigen::Vector3d(9.0, 0.0009, 0.0004).asDiagonal();
  map.Insert({EdgeAt(2.0)}, PoseBelow(2.06), covariance);
  EXPECT_NEAR(map.landmarks()[0].position.x(), 2.02, 1e-12);
  EXPECT_NEAR(map.landmarks()[0].covariance(0, 0), 0.0025 * 2.0 / 3.0, 1e-12);
}

TEST(EdgeMap, IgnoresAnEdgeThreeDeviationsOff) {
  // Variances: the landmark's across x is 0.0025 from the view along x, the image's 4e-6.
  ModelEdge sharp = EdgeAt(2.0);
  sharp.bearing_stddev = 0.001;
  EdgeMap map{EdgeMapOptions()};
  map.Insert({sharp}, PoseBelow(2.0), kExact);  // x known to 2 mm
  map.Insert({sharp}, PoseBelow(2.0 + 3.1 * std::sqrt(8e-6)), kExact);
  EXPECT_NEAR(map.landmarks()[0].position.x(), 2.0, 1e-12);
  EXPECT_EQ(map.landmarks()[0].hits, 1);
  map.Insert({sharp}, PoseBelow(2.0 + 2.9 * std::sqrt(8e-6)), kExact);
  EXPECT_NEAR(map.landmarks()[0].position.x(), 2.0 + 1.45 * std::sqrt(8e-6), 1e-12);
  EXPECT_EQ(map.landmarks()[0].hits, 2);
}

TEST(EdgeMap, StartsNoSecondLandmarkWithinTheSeparation) {
  EdgeMap map = MapWithOneLandmark();
  map.Insert({EdgeAt(2.0)}, PoseBelow(2.14), kExact);
  EXPECT_EQ(map.landmarks().size(), 1u);
  EXPECT_EQ(map.landmarks()[0].hits, 1);
  map.Insert({EdgeAt(2.0, 0.0, -1)}, PoseBelow(2.14), kExact);  // another sign is another edge
  EXPECT_EQ(map.landmarks().size(), 2u);
  map.Insert({EdgeAt(2.0)}, PoseBelow(2.16), kExact);
  EXPECT_EQ(map.landmarks().size(), 3u);
}

TEST(EdgeMap, KeepsASeparationOfMoreThanTwoGates) {
  EdgeMapOptions options;
  options.min_separation = 0.5;
  EdgeMap map(options);
  map.Insert({EdgeAt(2.0)}, Pose2(), kExact);
  map.Insert({EdgeAt(2.0)}, PoseBelow(2.4), kExact);
  EXPECT_EQ(map.landmarks().size(), 1u);
}

TEST(EdgeMap, FindsTheNearerOfTwoLandmarks) {
  EdgeMap map = MapWithOneLandmark();
  map.Insert({EdgeAt(2.0)}, PoseBelow(2.16), kExact);
  ASSERT_EQ(map.landmarks().size(), 2u);
  for (double x = 2.061; x < 2.099; x += 0.002) {
    const EdgeLandmark* found = map.Find(EdgeAt(2.0), RigidTransform2(PoseBelow(x)));
    EXPECT_EQ(found, &map.landmarks()[x < 2.08 ? 0 : 1]) << x;
  }
}

TEST(EdgeMapOptions, AreRefusedByName) {
  struct Named {
    const char* name;
    double EdgeMapOptions::*field;
  };
  for (const Named& named : {Named{"gate", &EdgeMapOptions::gate},
                             Named{"min_separation", &EdgeMapOptions::min_separation},
                             Named{"min_weight", &EdgeMapOptions::min_weight},
                             Named{"max_range", &EdgeMapOptions::max_range},
                             Named{"surface_stddev", &EdgeMapOptions::surface_stddev}}) {
    for (const double wrong : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
      EdgeMapOptions options;
      options.*named.field = wrong;
      try {
        const EdgeMap map(options);
        ADD_FAILURE() << named.name << " = " << wrong << " was accepted";
      } catch (const std::invalid_argument& error) {
        EXPECT_EQ(std::string(error.what()).find(named.name), 0u) << error.what();
      }
    }
  }
}

}  // namespace
}  // namespace scan_image_slam
