// Scans whose sweep was corrected with a wrong velocity.
#include "scan_image_slam/core/matching/local_map_matcher.h"
#include "support_rooms.h"

#include <cmath>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

const Pose2 kOrigin;

MotionPrediction Predicted(const Pose2& motion) {
  MotionPrediction prediction;
  prediction.motion = motion;
  prediction.dt = 0.05;
  prediction.from_encoders = true;
  prediction.window = {0.1, 0.1, 0.1};
  prediction.covariance = Eigen::Matrix3d::Identity();
  return prediction;
}

/// The same on the left as on the right: what a sweep around the front distorts cancels in the
/// turn.
const Room kSymmetricRoom{{{2.5, -1.5}, {2.5, 1.5}},
                          {{-1.0, 2.0}, {1.5, 2.0}},
                          {{-1.0, -2.0}, {1.5, -2.0}},
                          {{-3.0, -1.0}, {-3.0, 1.0}}};

/// A sweep of 40 ms, the first beam `first` seconds after the stamp, of a robot that moves.
TestLaser SweepingLaser(double first, const Velocity2& velocity) {
  TestLaser laser;
  laser.first_beam_time = first;
  laser.time_increment = 0.04 / laser.beams;
  laser.velocity = velocity;
  return laser;
}

/// The robot has moved with `velocity` for 50 ms, and the encoders have not noticed.
MatchOutcome MatchBlindEncoders(double first, const Velocity2& velocity) {
  LocalMapMatcher matcher{LocalMapMatcherOptions()};
  matcher.Start(ModelOf(kSymmetricRoom, kOrigin, 0, TestLaser()), kOrigin);
  return matcher.Match(
      ModelOf(kSymmetricRoom, Move(velocity, 0.05), 1, SweepingLaser(first, velocity)), kOrigin,
      Predicted(kOrigin));
}

TEST(SweepCorrection, IsNoneIfTheEncodersAreRight) {
  LocalMapMatcher matcher{LocalMapMatcherOptions()};
  matcher.Start(ModelOf(SeparateWalls(), kOrigin, 0, TestLaser()), kOrigin);
  const Velocity2 velocity{0.4, 0.0, 0.5};
  TestLaser laser = SweepingLaser(0.0, velocity);
  laser.assumed_velocity = velocity;
  const Pose2 motion = Move(velocity, 0.05);
  const MatchOutcome outcome =
      matcher.Match(ModelOf(SeparateWalls(), motion, 1, laser), kOrigin, Predicted(motion));
  EXPECT_EQ(outcome.sweep_correction.x, 0.0);
  EXPECT_EQ(outcome.sweep_correction.theta, 0.0);
  EXPECT_NEAR(outcome.deviation.angle, 0.0, 1e-5);
}

TEST(SweepCorrection, FindsTheTurnThatTheEncodersHaveMissed) {
  // The stamp is the middle of the sweep, so that the turn of 0.025 rad in 50 ms is 0.5 rad/s. The
  // outer beams are 20 ms and 10 mrad off before.
  const MatchOutcome outcome = MatchBlindEncoders(-0.02, {0.0, 0.0, 0.5});
  EXPECT_NEAR(outcome.sweep_correction.theta, 0.5, 0.02);
  EXPECT_NEAR(outcome.deviation.angle, 0.025, 0.0005);
  EXPECT_LT(outcome.rms, 0.002);
}

TEST(SweepCorrection, FindsTheWayThatTheEncodersHaveMissed) {
  const MatchOutcome outcome = MatchBlindEncoders(-0.02, {0.8, 0.0, 0.0});
  EXPECT_NEAR(outcome.sweep_correction.x, 0.8, 0.03);
  EXPECT_NEAR(outcome.deviation.distance, 0.04, 0.001);
}

TEST(SweepCorrection, LeavesAloneWhatIsFinerThanAScanCanTell) {
  // 20 ms at 4 mrad/s are 0.08 mrad.
  const MatchOutcome outcome = MatchBlindEncoders(-0.02, {0.0, 0.0, 0.004});
  EXPECT_EQ(outcome.sweep_correction.theta, 0.0);
}

TEST(SweepCorrection, AStepOfTheEncodersDuringTheSweepTurnsNothing) {
  // The robot stands. Encoders whose count changes by one tell 0.05 rad/s for the time of the
  // sweep, but nothing between the scans. Uncorrected, 1 mrad of heading would be wrong.
  LocalMapMatcher matcher{LocalMapMatcherOptions()};
  matcher.Start(ModelOf(kSymmetricRoom, kOrigin, 0, TestLaser()), kOrigin);
  TestLaser laser = SweepingLaser(0.0, {});
  laser.assumed_velocity = {0.0, 0.0, 0.05};
  const MatchOutcome outcome =
      matcher.Match(ModelOf(kSymmetricRoom, kOrigin, 1, laser), kOrigin, Predicted(kOrigin));
  EXPECT_NEAR(outcome.sweep_correction.theta, -0.05, 0.002);
  EXPECT_NEAR(outcome.deviation.angle, 0.0, 5e-5);
}

TEST(SweepCorrection, ImprovesAScanStampedAtItsFirstBeam) {
  // Uncorrected, the beams are 20 ms late in the mean: 0.01 rad of 0.025. At least half must go.
  const MatchOutcome outcome = MatchBlindEncoders(0.0, {0.0, 0.0, 0.5});
  EXPECT_NEAR(outcome.deviation.angle, 0.025, 0.005);
}

TEST(SweepCorrection, FindsTheTurnOfAScanStampedAtItsFirstBeam) {
  const MatchOutcome outcome = MatchBlindEncoders(0.0, {0.0, 0.0, 0.5});
  EXPECT_NEAR(outcome.sweep_correction.theta, 0.5, 0.02);
  EXPECT_NEAR(outcome.deviation.angle, 0.025, 0.0005);
}

/// A scan of a moving robot without encoders; the model was corrected with `assumed`.
MatchOutcome MatchWithoutEncoders(const Velocity2& velocity, const Velocity2& assumed) {
  LocalMapMatcher matcher{LocalMapMatcherOptions()};
  matcher.Start(ModelOf(SeparateWalls(), kOrigin, 0, TestLaser()), kOrigin);
  TestLaser laser = SweepingLaser(0.0, velocity);
  laser.assumed_velocity = assumed;
  const Pose2 motion = Move(velocity, 0.05);
  MotionPrediction prediction = Predicted(motion);
  prediction.from_encoders = false;
  return matcher.Match(ModelOf(SeparateWalls(), motion, 1, laser), kOrigin, prediction);
}

TEST(SweepCorrection, IsThePredictedVelocityWithoutEncoders) {
  const Velocity2 velocity{0.4, 0.0, 0.5};
  const MatchOutcome outcome = MatchWithoutEncoders(velocity, {});
  EXPECT_NEAR(outcome.sweep_correction.x, 0.4, 1e-9);
  EXPECT_NEAR(outcome.sweep_correction.theta, 0.5, 1e-9);
  EXPECT_NEAR(outcome.deviation.angle, 0.0, 1e-4);
  EXPECT_NEAR(outcome.deviation.distance, 0.0, 1e-4);
}

TEST(SweepCorrection, IsNotAppliedTwice) {
  const Velocity2 velocity{0.4, 0.0, 0.5};
  const MatchOutcome outcome = MatchWithoutEncoders(velocity, velocity);
  EXPECT_NEAR(outcome.sweep_correction.theta, 0.0, 0.02);
  EXPECT_NEAR(outcome.deviation.angle, 0.0, 1e-3);
}

TEST(SweepCorrection, TurnsAnEdgeBackByTheAgeOfItsImage) {
  ModelEdge edge;
  edge.camera = {0.2, 0.1};
  edge.bearing = 0.3;
  edge.time_offset = -0.02;
  const std::vector<ModelEdge> turned = CorrectSweep(std::vector<ModelEdge>{edge}, {0.0, 0.0, 0.5});
  EXPECT_NEAR(turned[0].bearing, 0.29, 1e-12);
  EXPECT_NEAR(turned[0].camera.x(), 0.2 * std::cos(0.01) + 0.1 * std::sin(0.01), 1e-12);
  EXPECT_NEAR(turned[0].camera.y(), 0.1 * std::cos(0.01) - 0.2 * std::sin(0.01), 1e-12);
  const std::vector<ModelEdge> moved = CorrectSweep(std::vector<ModelEdge>{edge}, {2.0, 0.0, 0.0});
  EXPECT_NEAR(moved[0].bearing, 0.3, 1e-12);
  EXPECT_NEAR(moved[0].camera.x(), 0.16, 1e-12);
  EXPECT_NEAR(moved[0].camera.y(), 0.1, 1e-12);
}

/// Where an image that was taken 40 ms before the scan shows a place, if the encoders have told
/// nothing of a turn of 0.5 rad/s that began 50 ms before it.
ModelEdge EdgeInOldImage(const Eigen::Vector2d& place) {
  ModelEdge edge;
  edge.bearing = std::atan2(place.y(), place.x()) - 0.005;
  edge.bearing_stddev = 0.0005;
  edge.range = place.norm();
  edge.range_stddev = 0.01;
  edge.time_offset = -0.04;
  edge.sign = 1;
  edge.weight = 1.0;
  return edge;
}

TEST(SweepCorrection, ATurnThatTheEncodersHaveMissedIsNoWayAlongACorridor) {
  const Room corridor{{{-6.0, -1.2}, {6.0, -1.2}}, {{-6.0, 1.2}, {6.0, 1.2}}};
  const Eigen::Vector2d place(2.0, 1.2);
  ModelEdge first = EdgeInOldImage(place);
  first.bearing += 0.005;
  FusedModel start = ModelOf(corridor, kOrigin, 0, TestLaser());
  start.edges = {first};
  LocalMapMatcher matcher{LocalMapMatcherOptions()};
  matcher.Start(start, kOrigin);
  const Velocity2 turning{0.0, 0.0, 0.5};
  FusedModel next = ModelOf(corridor, Move(turning, 0.05), 1, SweepingLaser(-0.02, turning));
  next.edges = {EdgeInOldImage(place)};
  const MatchOutcome outcome = matcher.Match(next, kOrigin, Predicted(kOrigin));
  EXPECT_NEAR(outcome.sweep_correction.theta, 0.5, 0.02);
  // An edge that stayed 20 mrad off would be taken for 9 cm of way.
  EXPECT_NEAR(outcome.deviation.distance, 0.0, 0.01);
}

}  // namespace
}  // namespace scan_image_slam
