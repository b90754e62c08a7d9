#include "scan_image_slam/core/matching/local_map.h"

#include "refinement_fixtures.h"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

/// A laser whose points all have the same variance, 0.01^2, when they look straight at a wall.
constexpr RangeNoise kNoise{0.01, 0.0};
const LocalMapOptions kOptions;
constexpr double kInformation = 1.0 / (1e-4 + 1e-6);  // of one such point: the map's floor is 1 mm

LocalMap EmptyMap() { return LocalMap(kOptions, kNoise); }

/// The same from the other side of the wall.
SurfacePoint PointFromBehind(double x, double y) {
  SurfacePoint p = PointAhead(x, y);
  p.ray = -p.ray;
  p.normal = -p.normal;
  return p;
}

LocalMap MapOf(const std::vector<SurfacePoint>& points) {
  LocalMap map = EmptyMap();
  for (const SurfacePoint& p : points) map.Insert({p}, Pose2());
  return map;
}

TEST(LocalMap, StartsAnElementWhereNothingIsKnown) {
  const LocalMap map = MapOf({PointAhead(2.0, 0.5)});
  ASSERT_EQ(map.elements().size(), 1u);
  const SurfaceElement& element = map.elements()[0];
  EXPECT_EQ(element.position, Eigen::Vector2f(2.0f, 0.5f));
  EXPECT_EQ(element.normal, Eigen::Vector2f(-1.0f, 0.0f));
  EXPECT_NEAR(element.information, kInformation, 1e-6 * kInformation);
  EXPECT_FLOAT_EQ(element.angle_information, 100.0f);
}

TEST(LocalMap, PlacesPointsByThePoseOfTheBase) {
  LocalMap map = EmptyMap();
  map.Insert({PointAhead(2.0, 0.5)}, {10.0, 20.0, M_PI / 2.0});
  EXPECT_NEAR(map.elements()[0].position.x(), 9.5, 1e-5);
  EXPECT_NEAR(map.elements()[0].position.y(), 22.0, 1e-5);
  EXPECT_NEAR(map.elements()[0].normal.x(), 0.0, 1e-6);
  EXPECT_NEAR(map.elements()[0].normal.y(), -1.0, 1e-6);
}

TEST(LocalMap, LeavesOutPointsWithoutANormal) {
  SurfacePoint p = PointAhead(2.0, 0.0);
  p.normal = {0.0, 0.0};
  EXPECT_TRUE(MapOf({p}).elements().empty());
}

TEST(LocalMap, RefinesAcrossTheWallAndNotAlongIt) {
  const LocalMap map = MapOf({PointAhead(2.0, 0.0), PointAhead(2.04, 0.03)});
  ASSERT_EQ(map.elements().size(), 1u);
  EXPECT_FLOAT_EQ(map.elements()[0].position.x(), 2.02f);
  EXPECT_EQ(map.elements()[0].position.y(), 0.0f);
}

TEST(LocalMap, AveragesPointsOfEqualInformation) {
  // Along the wall the points belong to one element; across it their mean is at 2.01.
  const LocalMap map = MapOf({PointAhead(2.0, 0.0), PointAhead(2.04, 0.01), PointAhead(1.98, 0.02),
                              PointAhead(2.02, -0.02)});
  ASSERT_EQ(map.elements().size(), 1u);
  EXPECT_NEAR(map.elements()[0].position.x(), 2.01, 1e-6);
  EXPECT_NEAR(map.elements()[0].information, 4.0 * kInformation, 1e-5 * kInformation);
  EXPECT_FLOAT_EQ(map.elements()[0].angle_information, 400.0f);
}

// All normals of a scan are wrong in one sense. An element has neighbours on both sides, which pull
// it to and fro; from one side alone they would shift it by 4 mm.
TEST(LocalMap, AnElementTakesThePointsOfAScanFromBothSides) {
  std::vector<SurfacePoint> wall;
  for (int i = 0; i <= 14; ++i) {
    SurfacePoint p = PointAhead(2.0, 0.008 * i);
    p.normal = Eigen::Vector2d(-std::cos(0.2), std::sin(0.2));
    wall.push_back(p);
  }
  LocalMap map = EmptyMap();
  map.Insert(wall, Pose2());
  ASSERT_EQ(map.elements().size(), 3u);  // at 0, 0.056 and 0.112 m along the wall
  const SurfaceElement& middle = map.elements()[1];
  const Eigen::Vector2d offset = middle.position.cast<double>() - Eigen::Vector2d(2.0, 0.056);
  EXPECT_NEAR(offset.norm(), 0.0, 1e-3);
}

TEST(LocalMap, WeighsPointsByTheirInformation) {
  // Under 60 degrees only half of the range's noise is across the wall: 1 / (0.25e-4 + 1e-6).
  SurfacePoint slanted = PointAhead(2.04, 0.0);
  slanted.ray = {0.5, std::sqrt(0.75)};
  const double information = 1.0 / 26e-6;
  const LocalMap map = MapOf({PointAhead(2.0, 0.0), slanted});
  ASSERT_EQ(map.elements().size(), 1u);
  EXPECT_NEAR(map.elements()[0].position.x(),
              2.0 + 0.04 * information / (information + kInformation), 1e-6);
  EXPECT_NEAR(map.elements()[0].information, information + kInformation, 1e-1);
}

TEST(LocalMap, AveragesNormalsByTheirVariance) {
  // 0.4 rad apart, the second one known four times as well: a line of unit vectors in proportion.
  SurfacePoint turned = PointAhead(2.0, 0.0);
  turned.normal = {-std::cos(0.4), std::sin(0.4)};
  turned.angle_variance = 0.0025;
  const LocalMap map = MapOf({PointAhead(2.0, 0.0), turned});
  const Eigen::Vector2d mean(-0.2 - 0.8 * std::cos(0.4), 0.8 * std::sin(0.4));
  EXPECT_NEAR((map.elements()[0].normal.cast<double>() - mean.normalized()).norm(), 0.0, 1e-6);
  EXPECT_FLOAT_EQ(map.elements()[0].angle_information, 500.0f);
}

TEST(LocalMap, StartsAnotherElementASpacingFarther) {
  EXPECT_EQ(MapOf({PointAhead(2.0, 0.0), PointAhead(2.0, 0.049)}).elements().size(), 1u);
  EXPECT_EQ(MapOf({PointAhead(2.0, 0.0), PointAhead(2.0, 0.051)}).elements().size(), 2u);
}

TEST(LocalMap, StartsAnotherElementBehindTheMergeOffset) {
  EXPECT_EQ(MapOf({PointAhead(2.0, 0.0), PointAhead(2.099, 0.0)}).elements().size(), 1u);
  const LocalMap map = MapOf({PointAhead(2.0, 0.0), PointAhead(2.101, 0.0)});
  ASSERT_EQ(map.elements().size(), 2u);
  EXPECT_EQ(map.elements()[0].position.x(), 2.0f);
}

TEST(LocalMap, KeepsTheSidesOfAThinWallApart) {
  const LocalMap map = MapOf({PointAhead(2.0, 0.0), PointFromBehind(2.06, 0.0)});
  ASSERT_EQ(map.elements().size(), 2u);
  EXPECT_EQ(map.elements()[0].position.x(), 2.0f);
  EXPECT_EQ(map.elements()[1].position.x(), 2.06f);
  EXPECT_EQ(map.elements()[0].normal.x(), -1.0f);
  EXPECT_EQ(map.elements()[1].normal.x(), 1.0f);
}

TEST(LocalMap, DoesNotMixTheSidesOfAWallThinnerThanItsSpacing) {
  // 20 mm apart the other side is too near to start an element of its own, and changes none.
  const LocalMap map = MapOf({PointAhead(2.0, 0.0), PointFromBehind(2.02, 0.0)});
  ASSERT_EQ(map.elements().size(), 1u);
  EXPECT_EQ(map.elements()[0].position.x(), 2.0f);
  EXPECT_EQ(map.elements()[0].normal.x(), -1.0f);
  EXPECT_NEAR(map.elements()[0].information, kInformation, 1e-6 * kInformation);
}

TEST(LocalMap, MergesNormalsUpToTheGivenCosine) {
  const auto turned = [](double angle) {
    SurfacePoint p = PointAhead(2.04, 0.0);
    p.normal = {-std::cos(angle), std::sin(angle)};
    return p;
  };
  EXPECT_EQ(MapOf({PointAhead(2.0, 0.0), turned(std::acos(0.71))}).elements().size(), 1u);
  EXPECT_EQ(MapOf({PointAhead(2.0, 0.0), turned(std::acos(0.69))}).elements().size(), 2u);
}

TEST(LocalMap, DoesNotGrowByPointsOfItsElements) {
  std::vector<SurfacePoint> row;
  for (int i = 0; i < 20; ++i) row.push_back(PointAhead(2.025, 0.025 + 0.1 * i));
  LocalMap map = EmptyMap();
  for (int i = 0; i < 5; ++i) map.Insert(row, Pose2());
  EXPECT_EQ(map.elements().size(), 20u);
}

TEST(LocalMap, MeasuresTheDistanceToAPieceOfWall) {
  const LocalMap map = MapOf({PointAhead(2.0, 0.0)});
  EXPECT_NEAR(map.Distance({2.0, 0.0}, 0.2), 0.0, 1e-7);
  EXPECT_NEAR(map.Distance({2.1, 0.02}, 0.2), 0.1, 1e-6);     // beside its half length of 25 mm
  EXPECT_NEAR(map.Distance({1.97, 0.065}, 0.2), 0.05, 1e-6);  // 3-4-5 from its upper end
  EXPECT_NEAR(map.Distance({2.03, -0.065}, 0.2), 0.05, 1e-6);
  EXPECT_EQ(map.Distance({2.1, 0.0}, 0.08), 0.08);  // farther than asked for
  EXPECT_EQ(map.Distance({2.5, 0.0}, 0.2), 0.2);    // out of reach
}

TEST(LocalMap, ForgetsAllWhenCleared) {
  LocalMap map = MapOf({PointAhead(2.0, 0.0)});
  EXPECT_NE(map.Nearest({2.0, 0.0}), nullptr);
  map.Clear();
  EXPECT_EQ(map.Nearest({2.0, 0.0}), nullptr);
  EXPECT_TRUE(map.elements().empty());
}

struct NamedOption {
  const char* name;
  double LocalMapOptions::*field;
};

TEST(LocalMapOptions, AreRefusedByName) {
  for (const NamedOption& named :
       {NamedOption{"spacing", &LocalMapOptions::spacing},
        NamedOption{"reach", &LocalMapOptions::reach},
        NamedOption{"max_merge_offset", &LocalMapOptions::max_merge_offset}}) {
    for (const double wrong : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
      LocalMapOptions options;
      options.*named.field = wrong;
      try {
        const LocalMap map(options, kNoise);
        ADD_FAILURE() << named.name << " = " << wrong << " was accepted";
      } catch (const std::invalid_argument& error) {
        EXPECT_EQ(std::string(error.what()).find(named.name), 0u) << error.what();
      }
    }
  }
}

TEST(LocalMapOptions, RefuseACosineBeyondOne) {
  LocalMapOptions options;
  options.min_normal_cosine = 1.5;
  EXPECT_THROW(options.Validate(), std::invalid_argument);
}

}  // namespace
}  // namespace scan_image_slam
