#include "scan_image_slam/core/matching/nearest_field.h"

#include "support_rooms.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

constexpr double kCell = 0.05;
constexpr double kReach = 0.25;

std::vector<Eigen::Vector2d> RandomPlaces(int count, double half_side, TestRandom* random) {
  std::vector<Eigen::Vector2d> places;
  for (int i = 0; i < count; ++i) {
    places.emplace_back(random->Uniform(-half_side, half_side),
                        random->Uniform(-half_side, half_side));
  }
  return places;
}

NearestField FieldOf(const std::vector<Eigen::Vector2d>& places) {
  NearestField field(kCell, kReach);
  for (std::size_t i = 0; i < places.size(); ++i) field.Insert(static_cast<int>(i), places[i]);
  return field;
}

double DistanceToNearest(const std::vector<Eigen::Vector2d>& places, const Eigen::Vector2d& at) {
  double nearest = 1e9;
  for (const Eigen::Vector2d& p : places) nearest = std::min(nearest, (p - at).norm());
  return nearest;
}

TEST(NearestField, IsExactAtTheCentresOfCells) {
  TestRandom random(1);
  const auto places = RandomPlaces(150, 2.0, &random);
  const NearestField field = FieldOf(places);
  constexpr double kFloat = 1e-6;  // distances are compared as floats
  for (int iy = -50; iy < 50; ++iy) {
    for (int ix = -50; ix < 50; ++ix) {
      const Eigen::Vector2d centre((ix + 0.5) * kCell, (iy + 0.5) * kCell);
      const double nearest = DistanceToNearest(places, centre);
      const int id = field.Nearest(centre);
      if (nearest > kReach + kFloat) {
        EXPECT_EQ(id, -1);
      } else if (nearest < kReach - kFloat) {
        ASSERT_GE(id, 0) << centre.transpose();
        EXPECT_NEAR((places[id] - centre).norm(), nearest, kFloat);
      }
    }
  }
}

TEST(NearestField, IsOffByLessThanADiagonalElsewhere) {
  TestRandom random(2);
  const auto places = RandomPlaces(150, 2.0, &random);
  const NearestField field = FieldOf(places);
  const double diagonal = kCell * std::sqrt(2.0);
  for (const Eigen::Vector2d& at : RandomPlaces(5000, 2.5, &random)) {
    const double nearest = DistanceToNearest(places, at);
    const int id = field.Nearest(at);
    if (id < 0) {
      EXPECT_GT(nearest, kReach - 0.5 * diagonal);
    } else {
      EXPECT_LT((places[id] - at).norm(), nearest + diagonal);
      EXPECT_LT((places[id] - at).norm(), kReach + 0.5 * diagonal);
    }
  }
}

TEST(NearestField, AnswersTheSameAnywhereInACell) {
  const NearestField field = FieldOf({{-0.31, 0.12}, {-0.27, 0.2}});
  for (const double x : {-0.2999, -0.28, -0.2501}) {
    for (const double y : {0.1501, 0.17, 0.1999}) {
      EXPECT_EQ(field.Nearest({x, y}), field.Nearest({-0.275, 0.175}));
    }
  }
}

TEST(NearestField, TellsNegativeCellsFromPositiveOnes) {
  // With a reach of half a cell, only the cell of each element knows it.
  NearestField field(1.0, 0.5);
  field.Insert(0, {0.5, 0.5});
  field.Insert(1, {-0.5, 0.5});
  field.Insert(2, {-0.5, -0.5});
  field.Insert(3, {0.5, -0.5});
  EXPECT_EQ(field.Nearest({0.1, 0.1}), 0);
  EXPECT_EQ(field.Nearest({-0.1, 0.1}), 1);
  EXPECT_EQ(field.Nearest({-0.1, -0.1}), 2);
  EXPECT_EQ(field.Nearest({0.1, -0.1}), 3);
  EXPECT_EQ(field.Nearest({-1.0, -1.0}), 2);  // a border belongs to the upper cell
  EXPECT_EQ(field.Nearest({0.0, 0.0}), 0);
  EXPECT_EQ(field.Nearest({1.1, 0.5}), -1);
}

TEST(NearestField, KeepsTheFirstOfTwoThatAreEquallyNear) {
  NearestField field(1.0, 2.0);
  field.Insert(7, {0.25, 0.5});
  field.Insert(8, {0.75, 0.5});
  EXPECT_EQ(field.Nearest({0.5, 0.5}), 7);
}

TEST(NearestField, KeepsItsContentWhileItGrowsInEveryDirection) {
  std::vector<Eigen::Vector2d> places;
  for (int ring = 0; ring < 40; ++ring) {
    const double angle = 2.4 * ring;  // goes round while it goes out: grows on every side in turn
    places.emplace_back(3.0 * ring * std::cos(angle), 3.0 * ring * std::sin(angle));
  }
  const NearestField field = FieldOf(places);
  for (std::size_t i = 0; i < places.size(); ++i) {
    EXPECT_EQ(field.Nearest(places[i]), static_cast<int>(i));
    EXPECT_EQ(field.Nearest(places[i] + Eigen::Vector2d(1.0, 0.0)), -1);
  }
}

TEST(NearestField, KnowsNothingFarAway) {
  NearestField field(kCell, kReach);
  EXPECT_EQ(field.Nearest({0.0, 0.0}), -1);
  field.Insert(0, {0.0, 0.0});
  EXPECT_EQ(field.Nearest({1e4, -1e4}), -1);
}

TEST(NearestField, ForgetsAllWhenCleared) {
  NearestField field = FieldOf({{0.0, 0.0}, {30.0, -30.0}});
  field.Clear();
  EXPECT_EQ(field.Nearest({0.0, 0.0}), -1);
  EXPECT_EQ(field.Nearest({30.0, -30.0}), -1);
  field.Insert(5, {1.0, 1.0});
  EXPECT_EQ(field.Nearest({1.0, 1.0}), 5);
  EXPECT_EQ(field.Nearest({0.0, 0.0}), -1);
}

}  // namespace
}  // namespace scan_image_slam
