#include "scan_image_slam/core/matching/motion_predictor.h"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

MotionPredictorOptions DecimalOptions() {
  MotionPredictorOptions options;
  options.bounds = {0.1, 0.01, 0.2, 0.001, 0.3, 0.02, 0.4, 0.002, 0.5, 0.5};
  options.noise.distance_per_distance = 0.1;
  options.noise.distance_per_time = 0.02;
  options.noise.min_distance = 0.003;
  options.noise.lateral_fraction = 0.5;
  options.noise.angle_per_angle = 0.2;
  options.noise.angle_per_distance = 0.03;
  options.noise.angle_per_time = 0.04;
  options.noise.min_angle = 0.005;
  options.lateral_per_distance_without_encoders = 2.0;
  return options;
}

void ExpectMotion(const Pose2& motion, const Pose2& expected) {
  EXPECT_NEAR(motion.x, expected.x, 1e-12);
  EXPECT_NEAR(motion.y, expected.y, 1e-12);
  EXPECT_NEAR(motion.theta, expected.theta, 1e-12);
}

/// Two scans at 1.0 s and 1.1 s, with nothing from the encoders and 0.05 m forward between them.
MotionPredictor WithoutEncoders() {
  MotionPredictor predictor(DecimalOptions());
  predictor.Update(FromSeconds(1.0), Pose2());
  predictor.Update(FromSeconds(1.1), {0.05, 0.0, 0.0});
  return predictor;
}

/// Readings at 1.0 s and 1.1 s: 0.2 m forward, while looking along y.
MotionPredictor WithEncoders() {
  MotionPredictor predictor(DecimalOptions());
  predictor.odometry().Add(FromSeconds(1.0), {3.0, 4.0, M_PI / 2.0});
  predictor.Update(FromSeconds(1.0), Pose2());
  predictor.odometry().Add(FromSeconds(1.1), {3.0, 4.2, M_PI / 2.0});
  return predictor;
}

TEST(MotionPredictor, KnowsNoMotionBeforeTheFirstScan) {
  MotionPredictor predictor(DecimalOptions());
  predictor.odometry().Add(FromSeconds(1.0), {3.0, 4.0, 0.5});
  const MotionPrediction first = predictor.Predict(FromSeconds(1.0));
  ExpectMotion(first.motion, Pose2());
  EXPECT_FALSE(first.from_encoders);
  EXPECT_EQ(first.window.half_distance, 0.0);
  ASSERT_TRUE(first.odom_from_base);
  ExpectMotion(*first.odom_from_base, {3.0, 4.0, 0.5});
}

TEST(MotionPredictor, TellsTheEncodersMotionInTheFrameOfTheBase) {
  const MotionPrediction prediction = WithEncoders().Predict(FromSeconds(1.1));
  EXPECT_TRUE(prediction.from_encoders);
  ExpectMotion(prediction.motion, {0.2, 0.0, 0.0});
  ASSERT_TRUE(prediction.odom_from_base);
  ExpectMotion(*prediction.odom_from_base, {3.0, 4.2, M_PI / 2.0});
  EXPECT_NEAR(prediction.dt, 0.1, 1e-12);
}

TEST(MotionPredictor, InterpolatesAndExtrapolatesTheEncoders) {
  ExpectMotion(WithEncoders().Predict(FromSeconds(1.05)).motion, {0.1, 0.0, 0.0});
  ExpectMotion(WithEncoders().Predict(FromSeconds(1.15)).motion, {0.3, 0.0, 0.0});
}

TEST(MotionPredictor, MakesWindowAndCovarianceFromTheEncoders) {
  // 0.2 m in 0.1 s, no turn.
  const MotionPrediction prediction = WithEncoders().Predict(FromSeconds(1.1));
  EXPECT_NEAR(prediction.window.half_distance, 0.001 + 0.02 + 0.02, 1e-12);
  EXPECT_NEAR(prediction.window.half_lateral, 0.5 * 0.041, 1e-12);
  EXPECT_NEAR(prediction.window.half_angle, 0.002 + 0.004 + 0.04, 1e-12);
  const double forward = 0.003 + 0.02 + 0.002;
  const double turn = 0.005 + 0.006 + 0.004;
  EXPECT_NEAR(prediction.covariance(0, 0), forward * forward, 1e-12);
  EXPECT_NEAR(prediction.covariance(1, 1), 0.25 * forward * forward, 1e-12);
  EXPECT_NEAR(prediction.covariance(2, 2), turn * turn, 1e-12);
  EXPECT_EQ(prediction.covariance(0, 1), 0.0);
  EXPECT_EQ(prediction.covariance(0, 2), 0.0);
}

TEST(MotionPredictor, AJumpOfTheEncodersIsWithinTheWindow) {
  // Standing still, the encoders turn by 150 degrees in a second: no error of theirs is so large,
  // and no reset was noticed, as a robot might turn so fast.
  MotionPredictor predictor(DecimalOptions());
  for (int i = 0; i < 3; ++i) {
    predictor.odometry().Add(FromSeconds(1.0 + i), Pose2());
    predictor.Update(FromSeconds(1.0 + i), Pose2());
  }
  const double jump = 150.0 * M_PI / 180.0;
  predictor.odometry().Add(FromSeconds(4.0), {0.0, 0.0, jump});
  const MotionPrediction prediction = predictor.Predict(FromSeconds(4.0));
  EXPECT_NEAR(prediction.motion.theta, jump, 1e-12);
  EXPECT_TRUE(prediction.window.Contains(ToArcCoordinates(prediction.motion.Inverse())));
}

TEST(MotionPredictor, CovarianceGrowsWithTheTurnAndTimeUpToAMaximum) {
  MotionPredictor predictor(DecimalOptions());
  predictor.odometry().Add(FromSeconds(1.0), {});
  predictor.Update(FromSeconds(1.0), Pose2());
  predictor.odometry().Add(FromSeconds(9.0), {0.0, 0.0, -0.4});
  const Eigen::Matrix3d covariance = predictor.Predict(FromSeconds(9.0)).covariance;
  EXPECT_NEAR(std::sqrt(covariance(0, 0)), 0.003 + 0.02 * 0.5, 1e-12);  // max_time, not 8 s
  EXPECT_NEAR(std::sqrt(covariance(2, 2)), 0.005 + 0.2 * 0.4 + 0.04 * 0.5, 1e-12);
}

TEST(MotionPredictor, KeepsTheVelocityWithoutEncoders) {
  const MotionPredictor predictor = WithoutEncoders();
  EXPECT_NEAR(predictor.velocity().x, 0.5, 1e-12);
  const MotionPrediction prediction = predictor.Predict(FromSeconds(1.2));
  EXPECT_FALSE(prediction.from_encoders);
  EXPECT_FALSE(prediction.odom_from_base);
  ExpectMotion(prediction.motion, {0.05, 0.0, 0.0});
  ExpectMotion(predictor.Predict(FromSeconds(1.3)).motion, {0.1, 0.0, 0.0});
}

TEST(MotionPredictor, KeepsTheArcWithoutEncoders) {
  MotionPredictor predictor(DecimalOptions());
  predictor.Update(FromSeconds(1.0), Pose2());
  predictor.Update(FromSeconds(1.1), Arc(0.1, 0.2));
  ExpectMotion(predictor.Predict(FromSeconds(1.15)).motion, Arc(0.05, 0.1));
}

TEST(MotionPredictor, DoesNotKeepTheVelocityForLong) {
  ExpectMotion(WithoutEncoders().Predict(FromSeconds(5.0)).motion, {0.25, 0.0, 0.0});
}

TEST(MotionPredictor, OpensTheWindowSidewaysWithoutEncoders) {
  // 0.05 m in 0.1 s; a third of the window is one standard deviation.
  const MotionPrediction prediction = WithoutEncoders().Predict(FromSeconds(1.2));
  EXPECT_NEAR(prediction.window.half_distance, 0.001 + 0.005 + 0.02, 1e-12);
  EXPECT_NEAR(prediction.window.half_lateral, 0.052, 1e-12);
  EXPECT_NEAR(prediction.window.half_angle, 0.002 + 0.001 + 0.04, 1e-12);
  EXPECT_NEAR(prediction.covariance(0, 0), std::pow(0.026 / 3.0, 2), 1e-12);
  EXPECT_NEAR(prediction.covariance(1, 1), std::pow(0.052 / 3.0, 2), 1e-12);
  EXPECT_NEAR(prediction.covariance(2, 2), std::pow(0.043 / 3.0, 2), 1e-12);
}

TEST(MotionPredictor, GoesOverToTheVelocityWhenTheEncodersFallSilent) {
  MotionPredictor predictor = WithEncoders();
  predictor.Update(FromSeconds(1.1), {0.1, 0.0, 0.0});  // matched: half of what the encoders said
  EXPECT_TRUE(predictor.Predict(FromSeconds(1.34)).from_encoders);
  const MotionPrediction silent = predictor.Predict(FromSeconds(1.36));  // 0.26 s without a word
  EXPECT_FALSE(silent.from_encoders);
  ExpectMotion(silent.motion, {0.26, 0.0, 0.0});
}

TEST(MotionPredictor, UsesEncodersThatComeBackFromTheSecondScanOn) {
  MotionPredictor predictor = WithoutEncoders();
  predictor.odometry().Add(FromSeconds(1.2), {7.0, 0.0, 0.0});
  const MotionPrediction first = predictor.Predict(FromSeconds(1.2));
  EXPECT_FALSE(first.from_encoders);
  EXPECT_TRUE(first.odom_from_base);
  predictor.Update(FromSeconds(1.2), first.motion);
  predictor.odometry().Add(FromSeconds(1.3), {7.02, 0.0, 0.0});
  const MotionPrediction second = predictor.Predict(FromSeconds(1.3));
  EXPECT_TRUE(second.from_encoders);
  ExpectMotion(second.motion, {0.02, 0.0, 0.0});
}

// Of a node that had too much to do to hear them.
TEST(MotionPredictor, UsesEncodersThatWereHeardAfterTheScanTheyReach) {
  MotionPredictor predictor = WithoutEncoders();
  for (int i = 0; i <= 22; ++i) {  // from 1.0 s on, at 0.3 m/s
    predictor.odometry().Add(FromSeconds(1.0 + 0.1 * i), {5.0 + 0.03 * i, 0.0, 0.0});
  }
  const MotionPrediction prediction = predictor.Predict(FromSeconds(3.15));
  EXPECT_TRUE(prediction.from_encoders);
  EXPECT_NEAR(prediction.motion.x, 0.615, 1e-9);
}

TEST(MotionPredictor, TakesNothingFromEncodersThatPausedAroundTheLastScan) {
  MotionPredictor predictor(DecimalOptions());
  predictor.odometry().Add(FromSeconds(0.5), {5.0, 0.0, 0.0});
  predictor.Update(FromSeconds(1.0), Pose2());
  predictor.odometry().Add(FromSeconds(2.0), {5.6, 0.0, 0.0});
  EXPECT_FALSE(predictor.Predict(FromSeconds(2.0)).from_encoders);
}

TEST(MotionPredictor, IsBlindAfterALongGapThatEncodersSayNothingOf) {
  MotionPredictor predictor = WithEncoders();
  predictor.Update(FromSeconds(1.1), {0.2, 0.0, 0.0});
  EXPECT_FALSE(predictor.Predict(FromSeconds(1.59)).blind) << "the window reaches 0.5 s";
  EXPECT_TRUE(predictor.Predict(FromSeconds(1.61)).blind);
  for (int i = 1; i <= 6; ++i) predictor.odometry().Add(FromSeconds(1.1 + 0.1 * i), Pose2());
  EXPECT_FALSE(predictor.Predict(FromSeconds(1.61)).blind);
}

TEST(MotionPredictor, TakesRoughlyTheEncodersMotionAcrossALongGapWithAPause) {
  MotionPredictor predictor(DecimalOptions());
  predictor.odometry().Add(FromSeconds(0.5), {5.0, 0.0, 0.0});
  predictor.Update(FromSeconds(1.0), Pose2());
  predictor.odometry().Add(FromSeconds(2.5), {6.0, 0.0, 0.0});
  const MotionPrediction rough = predictor.Predict(FromSeconds(2.5));
  EXPECT_TRUE(rough.blind);
  EXPECT_FALSE(rough.from_encoders);
  ExpectMotion(rough.motion, {0.75, 0.0, 0.0});
  EXPECT_NEAR(rough.window.half_lateral, 2.0 * rough.window.half_distance, 1e-12);
}

TEST(MotionPredictor, IsNotBlindWhereEncodersNeverSpoke) {
  EXPECT_FALSE(WithoutEncoders().Predict(FromSeconds(5.0)).blind);
}

TEST(MotionPredictor, IsNotBlindBetweenTheScansOfASlowLaser) {
  MotionPredictor slow(DecimalOptions());
  slow.odometry().Add(FromSeconds(0.1), Pose2());
  for (const double seconds : {1.0, 2.0}) slow.Update(FromSeconds(seconds), Pose2());
  EXPECT_FALSE(slow.Predict(FromSeconds(3.0)).blind);
  EXPECT_FALSE(slow.Predict(FromSeconds(4.9)).blind);
  EXPECT_TRUE(slow.Predict(FromSeconds(5.1)).blind);
}

TEST(MotionPredictor, TakesTheUsualPeriodForStampsThatJitter) {
  MotionPredictor predictor = WithoutEncoders();
  const MotionPrediction early = predictor.Predict(FromSeconds(1.11));
  EXPECT_NEAR(early.dt, 0.1, 1e-12);
  EXPECT_NEAR(early.window.half_angle, 0.002 + 0.02 * 0.005 + 0.4 * 0.1, 1e-12);
  EXPECT_NEAR(predictor.Predict(FromSeconds(1.3)).dt, 0.2, 1e-12);  // a longer time counts in full
}

TEST(MotionPredictor, LearnsTheUsualPeriodSlowly) {
  MotionPredictor predictor = WithoutEncoders();
  predictor.Update(FromSeconds(1.3), Pose2());  // 0.1 s, then 0.2 s: 2 % of the way
  EXPECT_NEAR(predictor.Predict(FromSeconds(1.31)).dt, 0.102, 1e-12);
  MotionPredictor after_a_gap = WithoutEncoders();
  after_a_gap.Update(FromSeconds(100.0), Pose2());  // a gap counts as three periods
  EXPECT_NEAR(after_a_gap.Predict(FromSeconds(100.01)).dt, 0.104, 1e-12);
}

TEST(MotionPredictor, PredictsASteadyMotionWithJitteringStamps) {
  MotionPredictor predictor{MotionPredictorOptions()};
  const Pose2 motion{0.015, 0.0, 0.0};  // each 25 ms
  for (const double seconds : {1.0, 1.025, 1.05, 1.075, 1.099, 1.1}) {
    predictor.Update(FromSeconds(seconds), motion);
  }
  const MotionPrediction prediction = predictor.Predict(FromSeconds(1.15));
  EXPECT_TRUE(prediction.window.Contains(ToArcCoordinates(prediction.motion.Inverse() * motion)))
      << "predicted " << prediction.motion.x;
}

std::string Complaint(const MotionPredictorOptions& options) {
  try {
    const MotionPredictor predictor(options);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(MotionPredictorOptions, AreRefusedByName) {
  struct Named {
    const char* name;
    double MotionNoise::*field;
  };
  for (const Named& named : {Named{"distance_per_distance", &MotionNoise::distance_per_distance},
                             Named{"distance_per_time", &MotionNoise::distance_per_time},
                             Named{"min_distance", &MotionNoise::min_distance},
                             Named{"lateral_fraction", &MotionNoise::lateral_fraction},
                             Named{"angle_per_angle", &MotionNoise::angle_per_angle},
                             Named{"angle_per_distance", &MotionNoise::angle_per_distance},
                             Named{"angle_per_time", &MotionNoise::angle_per_time},
                             Named{"min_angle", &MotionNoise::min_angle}}) {
    for (const double wrong : {-1e-9, std::nan(""), std::numeric_limits<double>::infinity()}) {
      MotionPredictorOptions options;
      options.noise.*named.field = wrong;
      EXPECT_EQ(Complaint(options).find(std::string(named.name) + " must be"), 0u) << named.name;
    }
  }
  MotionPredictorOptions options;
  options.bounds.max_time = -1.0;
  EXPECT_EQ(Complaint(options).find("max_time"), 0u);
  EXPECT_EQ(Complaint(MotionPredictorOptions()), "");
}

TEST(MotionPredictorOptions, RefuseANegativeSidewaysBound) {
  MotionPredictorOptions options;
  options.lateral_per_distance_without_encoders = -1.0;
  EXPECT_EQ(Complaint(options).find("lateral_per_distance_without_encoders"), 0u);
}

}  // namespace
}  // namespace scan_image_slam
