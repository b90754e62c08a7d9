// People who walk by are small, stand in front of what is beside them, and do not stay: neither the
// laser's points on them nor the camera's edges may move the pose.
#include "scan_image_slam/core/matching/local_map_matcher.h"
#include "support_rooms.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

const Pose2 kOrigin;

TestLaser ShortSighted() {
  TestLaser laser;
  laser.max_range = 10.0;
  return laser;
}

std::vector<SurfacePoint> SurfaceOf(const Room& room) {
  return EstimateSurface(ModelOf(room, kOrigin, 0, ShortSighted()), SurfaceOptions(), RangeNoise());
}

/// Detached points, and all points, nearer than the walls of the plain corridor.
std::pair<int, int> DetachedWithin(const Room& thing) {
  int detached = 0;
  int all = 0;
  for (const SurfacePoint& p : SurfaceOf(PlainCorridor() + thing)) {
    if (std::abs(p.point.y()) > 0.99) {
      EXPECT_FALSE(p.detached) << p.point.transpose();
      continue;
    }
    ++all;
    detached += p.detached ? 1 : 0;
  }
  EXPECT_GT(all, 10);
  return {detached, all};
}

TEST(Detached, IsALegInFrontOfAWall) {
  const auto [detached, all] = DetachedWithin(Rectangle(1.0, 0.3, 1.12, 0.42));
  EXPECT_EQ(detached, all);
}

TEST(Detached, AreTwoLegsOfWhichOneHidesPartOfTheOther) {
  const auto [detached, all] =
      DetachedWithin(Rectangle(1.0, 0.3, 1.12, 0.42) + Rectangle(1.3, 0.45, 1.42, 0.57));
  EXPECT_EQ(detached, all);
}

TEST(Detached, IsNothingAsWideAsACupboard) {
  const auto [detached, all] = DetachedWithin(Rectangle(1.0, 0.0, 1.4, 0.9));
  EXPECT_EQ(detached, 0) << "of " << all;
}

TEST(Detached, IsNotTheWallThatIsSeenBetweenTwoThings) {
  // DetachedWithin expects it of the walls; here 0.3 m of one are left to be seen.
  DetachedWithin(Rectangle(-1.0, 0.3, -0.15, 0.5) + Rectangle(0.15, 0.3, 1.0, 0.5));
}

TEST(Detached, IsNotARoomThatIsSeenAllRound) {
  for (const SurfacePoint& p : SurfaceOf(Rectangle(-2.0, -1.5, 3.0, 2.5))) {
    EXPECT_FALSE(p.detached) << p.point.transpose();
  }
}

SurfacePoint Leg() {
  SurfacePoint p;
  p.point = {2.0, 0.0};
  p.ray = {1.0, 0.0};
  p.normal = {-1.0, 0.0};
  p.range = 2.0;
  p.angle_variance = 0.01;
  return p;
}

bool Stands(const LocalMap& map) { return map.elements().front().stands; }

TEST(LocalMap, WhatWasSeenForAWhileStands) {
  LocalMapOptions options;
  options.still_time = 1.0;
  LocalMap map(options, RangeNoise());
  for (const double time : {5.0, 5.3, 5.6, 5.9}) map.Insert({Leg()}, kOrigin, 0.0, time);
  EXPECT_FALSE(Stands(map));
  map.Insert({Leg()}, kOrigin, 0.0, 6.1);
  EXPECT_TRUE(Stands(map));
  // It stays, although it is out of view for long.
  for (int i = 0; i < 20; ++i) map.Insert({}, kOrigin, 0.0, 7.0 + i);
  map.Insert({Leg()}, kOrigin, 0.0, 30.0);
  EXPECT_TRUE(Stands(map));
}

TEST(LocalMap, WhatComesAgainHasNotStood) {
  LocalMapOptions options;
  options.still_time = 1.0;
  LocalMap map(options, RangeNoise());
  for (int passer_by = 0; passer_by < 5; ++passer_by) {
    map.Insert({Leg()}, kOrigin, 0.0, 2.0 * passer_by);
    map.Insert({Leg()}, kOrigin, 0.0, 2.0 * passer_by + 0.3);
    for (int i = 0; i < 4; ++i) map.Insert({}, kOrigin, 0.0, 2.0 * passer_by + 0.6 + 0.3 * i);
  }
  EXPECT_FALSE(Stands(map));
}

/// A robot that drives along the plain corridor at 0.6 m/s, told by exact encoders.
class CorridorDrive {
 public:
  static constexpr double kPeriod = 0.025;  // [s]
  static constexpr double kSpeed = 0.6;     // [m/s]

  CorridorDrive() { matcher_.Start(Seen({}, {}), pose_); }

  /// One scan, with things in the corridor and edges of the image; how far the pose then is off.
  double Step(const Room& things, const std::vector<ModelEdge>& edges = {}) {
    truth_.x += kSpeed * kPeriod;
    MotionPrediction prediction;
    prediction.motion = {kSpeed * kPeriod, 0.0, 0.0};
    prediction.dt = kPeriod;
    prediction.from_encoders = true;
    prediction.window = {0.025, 0.05, 0.05};
    prediction.covariance = Eigen::Vector3d(1e-3, 1e-4, 1e-3).cwiseAbs2().asDiagonal();
    const MatchOutcome outcome = matcher_.Match(Seen(things, edges), pose_, prediction);
    pose_ = pose_ * prediction.motion * FromArcCoordinates(outcome.deviation);
    degenerate_ = outcome.degenerate;
    points_ = outcome.points;
    return pose_.x - truth_.x;
  }

  bool degenerate() const { return degenerate_; }
  int points() const { return points_; }  ///< of the scan, that were matched or might have been
  const Pose2& truth() const { return truth_; }
  const LocalMapMatcher& matcher() const { return matcher_; }

 private:
  FusedModel Seen(const Room& things, const std::vector<ModelEdge>& edges) const {
    FusedModel model = ModelOf(PlainCorridor() + things, truth_, 1, ShortSighted());
    model.edges = edges;
    return model;
  }

  Pose2 truth_;
  Pose2 pose_;
  LocalMapMatcher matcher_{LocalMapMatcherOptions()};
  bool degenerate_ = false;
  int points_ = 0;
};

Room BoxAt(double x, double y) { return Rectangle(x, y, x + 0.15, y + 0.15); }

TEST(Walkers, DoNotDragThePoseAlongACorridor) {
  CorridorDrive drive;
  for (int i = 0; i < 60; ++i) drive.Step({});
  double worst = 0.0;
  for (int i = 0; i < 160; ++i) {                    // towards the robot, and past it
    const double x = 4.0 - 1.2 * drive.kPeriod * i;  // as wide as a skirt: to be seen well
    const double off = drive.Step(Rectangle(x, 0.1, x + 0.3, 0.7));
    worst = std::max(worst, std::abs(off));
    EXPECT_TRUE(drive.degenerate()) << i;
  }
  EXPECT_LT(worst, 0.001);
}

TEST(Walkers, WhatHasStoodForAWhileIsMatched) {
  CorridorDrive drive;
  for (int i = 0; i < 60; ++i) drive.Step({});
  const int beams = drive.points();  // what stands in front of a wall is hit instead of it
  const Room box = BoxAt(5.0, 0.4);
  for (int i = 0; i < 30; ++i) {
    drive.Step(box);
    EXPECT_LT(drive.points(), beams) << i;
  }
  for (int i = 0; i < 30; ++i) drive.Step(box);
  EXPECT_GE(drive.points(), beams);
}

ModelEdge EdgeAt(const Eigen::Vector2d& place, const Pose2& base) {
  const Eigen::Vector2d ray = place - base.translation();
  ModelEdge edge;
  edge.bearing = std::atan2(ray.y(), ray.x());
  edge.bearing_stddev = 0.0005;
  edge.range = ray.norm();
  edge.range_stddev = 0.01;
  edge.sign = 1;
  edge.weight = 1.0;
  return edge;
}

/// Edges that the matcher follows, of one on the right wall, and one on the left wall behind
/// shoulders that are `beside` the walker's legs.
int EdgesFollowed(double beside) {
  CorridorDrive drive;
  for (int i = 0; i < 60; ++i) drive.Step({});
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector2d base = drive.truth().translation();
    const Eigen::Vector2d legs = base + Eigen::Vector2d(1.5, 0.3);
    const Eigen::Vector2d shoulder = legs + Eigen::Vector2d(0.075, 0.075 + beside);
    const Eigen::Vector2d ray = (shoulder - base).normalized();
    const Eigen::Vector2d on_wall = base + ray * (1.0 - base.y()) / ray.y();
    const Pose2 next{base.x() + drive.kSpeed * drive.kPeriod, base.y(), 0.0};
    drive.Step(BoxAt(legs.x(), legs.y()), {EdgeAt({4.0, -1.0}, next), EdgeAt(on_wall, next)});
  }
  return drive.matcher().filter().edges();
}

TEST(Walkers, HideTheEdgesBehindTheirShoulders) {
  EXPECT_EQ(EdgesFollowed(0.2), 1);
  EXPECT_EQ(EdgesFollowed(0.7), 2);
}

}  // namespace
}  // namespace scan_image_slam
