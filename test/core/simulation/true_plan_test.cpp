#include "scan_image_slam/core/simulation/true_plan.h"

#include "plain_world.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

// The laser stands at (2, 2) in a room of 10 m by 4 m and looks along x, 135 degrees to both sides:
// it sees three walls.
constexpr int kEast = 1;
constexpr int kNorth = 2;

LaserSimulatorOptions LaserAtBase() {
  LaserSimulatorOptions laser;
  laser.mount.x = 0.0;
  return laser;
}

TruePlan PlanOf(const World& world, const LaserSimulatorOptions& laser = LaserAtBase()) {
  return SeenPlan(world, laser, {{2.0, 2.0, 0.0}}, 0.05);
}

bool Has(const TruePlan& plan, const Wall& wall) {
  return std::any_of(plan.walls.begin(), plan.walls.end(),
                     [&](const TrueWall& w) { return w.from == wall.from && w.to == wall.to; });
}

/// Largest distance along x from the laser to a point seen on the north wall, corners left out.
double ReachOnNorth(const TruePlan& plan) {
  double reach = 0.0;
  for (const Eigen::Vector2d& p : plan.seen) {
    if (p.y() > 3.999 && p.x() < 9.9) reach = std::max(reach, p.x() - 2.0);
  }
  return reach;
}

/// The same across x for the east wall.
double ReachOnEast(const TruePlan& plan) {
  double reach = 0.0;
  for (const Eigen::Vector2d& p : plan.seen) {
    if (p.x() > 9.999) reach = std::max(reach, std::abs(p.y() - 2.0));
  }
  return reach;
}

TEST(SeenPlan, HoldsTheWallsInView) {
  const World world = PlainRoom(10.0, 4.0);
  const TruePlan plan = PlanOf(world);
  EXPECT_EQ(plan.walls.size(), 3U);
  EXPECT_FALSE(Has(plan, world.walls[3]));  // behind the laser
  ASSERT_FALSE(plan.seen.empty());
  for (const Eigen::Vector2d& p : plan.seen) {
    const double distance =
        std::min({std::abs(p.y()), std::abs(4.0 - p.y()), std::abs(10.0 - p.x())});
    EXPECT_LT(distance, 0.05);
    EXPECT_GE(p.x(), -1e-9);
  }
}

TEST(SeenPlan, HasOnePointPerCell) {
  // From 2 m away there are beams in every 5 cm of the wall right beside the laser.
  const TruePlan plan = PlanOf(PlainRoom(10.0, 4.0));
  const auto beside = std::count_if(
      plan.seen.begin(), plan.seen.end(),
      [](const Eigen::Vector2d& p) { return p.y() < 0.01 && p.x() >= 1.5 && p.x() < 2.5; });
  EXPECT_EQ(beside, 20);
}

TEST(SeenPlan, LooksFromEveryPose) {
  const World world = PlainRoom(10.0, 4.0);
  const TruePlan plan = SeenPlan(world, LaserAtBase(), {{2.0, 2.0, 0.0}, {5.0, 2.0, M_PI}}, 0.05);
  EXPECT_TRUE(Has(plan, world.walls[3]));
  EXPECT_EQ(plan.walls.size(), 4U);
}

TEST(SeenPlan, LaserIsWhereItIsMounted) {
  LaserSimulatorOptions laser = LaserAtBase();
  laser.mount.x = 1.0;
  laser.range_max = 7.5;
  EXPECT_TRUE(Has(PlanOf(PlainRoom(10.0, 4.0), laser), PlainRoom(10.0, 4.0).walls[kEast]));
  laser.mount.x = 0.0;  // 8 m from the wall
  EXPECT_FALSE(Has(PlanOf(PlainRoom(10.0, 4.0), laser), PlainRoom(10.0, 4.0).walls[kEast]));
}

TEST(SeenPlan, NothingIsSeenThroughWalls) {
  World world = PlainRoom(10.0, 4.0);
  AddPlainWall(world, {5.0, 0.0}, {5.0, 4.0});
  const TruePlan plan = PlanOf(world);
  EXPECT_FALSE(Has(plan, world.walls[kEast]));
  for (const Eigen::Vector2d& p : plan.seen) EXPECT_LE(p.x(), 5.0 + 1e-9);
}

TEST(SeenPlan, PeopleAreNoPartOfIt) {
  World world = PlainRoom(10.0, 4.0);
  Person person;
  person.path = {{{4.0, 2.0}, 0.0}};
  const TruePlan without = PlanOf(world);
  world.people.push_back(person);
  EXPECT_EQ(PlanOf(world).seen, without.seen);
}

TEST(SeenPlan, GrazedWallsAreThereButNotSeen) {
  LaserSimulatorOptions laser = LaserAtBase();
  laser.grazing_drop_angle = 1.0;
  const World world = PlainRoom(10.0, 4.0);
  EXPECT_NEAR(ReachOnNorth(PlanOf(world, laser)), 2.0 * std::tan(1.0), 0.05);
}

TEST(SeenPlan, DarkWallsAreSeenFromNear) {
  LaserSimulatorOptions laser = LaserAtBase();
  laser.dark_range = 2.5;
  World world = PlainRoom(10.0, 4.0);
  EXPECT_GT(ReachOnNorth(PlanOf(world, laser)), 7.0);
  world.walls[kNorth].laser = LaserReturn::kDark;
  EXPECT_NEAR(ReachOnNorth(PlanOf(world, laser)), 1.5, 0.05);
}

TEST(SeenPlan, GlassIsSeenHeadOnAndThrough) {
  LaserSimulatorOptions laser = LaserAtBase();
  laser.glass_angle = 0.12;
  World world = PlainRoom(10.0, 4.0);
  world.walls[kEast].laser = LaserReturn::kGlass;
  const int behind = AddPlainWall(world, {12.0, -2.0}, {12.0, 6.0});
  const TruePlan plan = PlanOf(world, laser);
  EXPECT_TRUE(Has(plan, world.walls[kEast]));
  EXPECT_TRUE(Has(plan, world.walls[behind]));
  const auto on_glass = [](const Eigen::Vector2d& p) { return std::abs(p.x() - 10.0) < 1e-6; };
  double reach = 0.0;
  for (const Eigen::Vector2d& p : plan.seen) {
    if (on_glass(p)) reach = std::max(reach, std::abs(p.y() - 2.0));
  }
  EXPECT_NEAR(reach, 8.0 * std::tan(0.12), 0.05);
  EXPECT_GT(ReachOnEast(plan), 1.9);  // behind the glass
}

TEST(SeenPlan, GlassBehindAWallIsNotSeen) {
  World world = PlainRoom(10.0, 4.0);
  world.walls[kEast].laser = LaserReturn::kGlass;
  AddPlainWall(world, {5.0, 0.0}, {5.0, 4.0});
  EXPECT_FALSE(Has(PlanOf(world), world.walls[kEast]));
}

TEST(SeenPlan, WhatIsTooNearIsNotSeen) {
  LaserSimulatorOptions laser = LaserAtBase();
  laser.range_min = 2.5;
  double nearest = 1e9;
  for (const Eigen::Vector2d& p : PlanOf(PlainRoom(10.0, 4.0), laser).seen) {
    nearest = std::min(nearest, (p - Eigen::Vector2d(2.0, 2.0)).norm());
  }
  EXPECT_NEAR(nearest, 2.5, 0.05);
}

}  // namespace
}  // namespace scan_image_slam
