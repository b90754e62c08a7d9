#include "scan_image_slam/core/calibration/jump_sight.h"

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

/// Seen by a camera at the origin of the base; the edge and the discontinuity are both ahead.
struct Seen {
  JumpSight sight;
  ViewedEdge edge;
  CalibrationVector correction{};

  Seen() { sight.point = {2.0, 0.0}; }
  double Residual() const {
    return BearingResidual(sight, edge, Eigen::Vector2d(0.0, 0.0), correction.data());
  }
};

TEST(BearingResidual, IsHowFarTheEdgeLiesToTheLeft) {
  Seen seen;
  EXPECT_DOUBLE_EQ(seen.Residual(), 0.0);
  seen.edge.bearing = 0.1;
  EXPECT_NEAR(seen.Residual(), 0.1, 1e-12);
  seen.sight.point = {2.0, 2.0};
  EXPECT_NEAR(seen.Residual(), 0.1 - M_PI / 4.0, 1e-12);
}

TEST(BearingResidual, WrapsBehindTheRobot) {
  Seen seen;
  seen.sight.point = {-2.0, 0.0};
  seen.edge.bearing = -3.1;
  EXPECT_NEAR(seen.Residual(), M_PI - 3.1, 1e-12);
}

TEST(BearingResidual, FollowsEachCorrection) {
  Seen yaw;
  yaw.correction[kYaw] = 0.05;
  EXPECT_NEAR(yaw.Residual(), 0.05, 1e-12);
  Seen left;  // the camera 1 m to the left sees the point to its right
  left.correction[kLeft] = 1.0;
  EXPECT_NEAR(left.Residual(), std::atan2(1.0, 2.0), 1e-12);
  Seen forward;
  forward.sight.point = {2.0, 1.0};
  forward.correction[kForward] = 1.0;
  EXPECT_NEAR(forward.Residual(), -M_PI / 4.0, 1e-12);
  Seen border;  // the true border is narrower than the laser's
  border.sight.side = 1;
  border.correction[kBorder] = 0.01;
  EXPECT_NEAR(border.Residual(), 0.01, 1e-12);
}

TEST(BearingResidual, MovesTheBaseWithTheDelay) {
  Seen turning;  // to the left at 1 rad/s: later the point is farther to the right
  turning.sight.velocity = {0.0, 0.0, 1.0};
  turning.sight.time_offset = 0.02;
  turning.correction[kTime] = 0.05;
  EXPECT_NEAR(turning.Residual(), 0.03, 1e-12);
  Seen driving;
  driving.sight.point = {2.0, 1.0};
  driving.sight.velocity = {10.0, 0.0, 0.0};
  driving.correction[kTime] = 0.1;
  EXPECT_NEAR(driving.Residual(), -M_PI / 4.0, 1e-12);
}

TEST(BearingResidual, TakesTheTiltOutOfABearingAboveTheHorizon) {
  // Rolled clockwise, a level camera would see a post ahead that rises to slope 1 lean to its left
  // by the roll: what it takes for the bearing there is too far left.
  Seen seen;
  seen.edge.bearing = 0.02;
  seen.edge.slope = 1.0;
  seen.correction[kTiltX] = 0.02;
  EXPECT_NEAR(seen.Residual(), 0.02 - 0.02 * std::cos(0.02), 1e-12);
}

/// Turns at 1 rad/s on the spot; one discontinuity 2 m ahead at time 5 s.
CalibrationData Turning() {
  CalibrationData data;
  for (int i = 0; i <= 100; ++i) {
    const double t = 4.0 + 0.02 * i;
    data.trajectory.push_back({FromSeconds(t), {0.0, 0.0, t - 5.0}});
  }
  CalibrationView view;
  view.stamp = FromSeconds(5.1);
  view.jumps.push_back({FromSeconds(5.0), {2.0, 0.0}, -1, 0.001});
  data.views.push_back(view);
  return data;
}

TEST(SightJumps, MovesTheDiscontinuityToTheTimeOfThePicture) {
  const std::vector<JumpSight> sights = SightJumps(Turning(), 0.1);
  ASSERT_EQ(sights.size(), 1U);
  EXPECT_NEAR(std::atan2(sights[0].point.y(), sights[0].point.x()), -0.2, 1e-6);
  EXPECT_NEAR(sights[0].point.norm(), 2.0, 1e-9);
  EXPECT_NEAR(sights[0].velocity.theta, 1.0, 1e-6);
  EXPECT_EQ(sights[0].side, -1);
}

TEST(SightJumps, HasNoneWhereThePoseIsNotKnown) {
  EXPECT_TRUE(SightJumps(Turning(), 2.0).empty());
  CalibrationData data = Turning();
  data.views[0].jumps[0].fired = FromSeconds(3.0);
  EXPECT_TRUE(SightJumps(data, 0.0).empty());
}

TEST(PairNearest, TakesTheNearestEdgeWithinTheGate) {
  CalibrationData data = Turning();
  for (const double bearing : {-0.2, -0.11, -0.07}) {
    ViewedEdge edge;
    edge.bearing = bearing;
    data.views[0].edges.push_back(edge);
  }
  const std::vector<JumpSight> sights = SightJumps(data, 0.0);  // at -0.1
  const auto pairs = PairNearest(data, sights, CalibrationVector{}, 0.05);
  ASSERT_EQ(pairs.size(), 1U);
  EXPECT_DOUBLE_EQ(pairs[0].edge.bearing, -0.11);
  EXPECT_TRUE(PairNearest(data, sights, CalibrationVector{}, 0.005).empty());
}

}  // namespace
}  // namespace scan_image_slam
