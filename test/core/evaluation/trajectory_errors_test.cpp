#include "scan_image_slam/core/evaluation/trajectory_errors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

constexpr double kTolerance = 1e-9;
constexpr double kDegree = M_PI / 180.0;

/// Straight ahead along x with 1 m/s: `steps` steps of `length` m, each `scale` times as long.
Trajectory StraightLine(int steps, double scale = 1.0, double length = 0.1) {
  Trajectory trajectory;
  for (int i = 0; i <= steps; ++i) {
    trajectory.push_back({FromSeconds(length * i), {length * i * scale, 0.0, 0.0}});
  }
  return trajectory;
}

/// A winding way of 20 s, with an error that is different everywhere if `error` is not 0.
Trajectory Winding(double error = 0.0) {
  Trajectory trajectory;
  for (int i = 0; i <= 400; ++i) {
    const double t = 0.05 * i;
    trajectory.push_back({FromSeconds(t),
                          {2.0 * t + error * std::sin(3.0 * t), 3.0 * std::sin(t / 3.0) + error * t,
                           std::cos(t / 3.0) + error * std::cos(t)}});
  }
  return trajectory;
}

Trajectory Moved(const Pose2& motion, Trajectory trajectory) {
  for (StampedPose& pose : trajectory) pose.pose = motion * pose.pose;
  return trajectory;
}

TrajectoryErrors Evaluate(const Trajectory& reference, const Trajectory& estimate,
                          Alignment alignment = Alignment::kFirst) {
  TrajectoryErrorOptions options;
  options.alignment = alignment;
  return EvaluateTrajectory(reference, estimate, options);
}

void ExpectEqual(const Statistics& a, const Statistics& b) {
  EXPECT_EQ(a.count, b.count);
  EXPECT_NEAR(a.mean, b.mean, kTolerance);
  EXPECT_NEAR(a.median, b.median, kTolerance);
  EXPECT_NEAR(a.rms, b.rms, kTolerance);
  EXPECT_NEAR(a.max, b.max, kTolerance);
}

void ExpectEqualRelativeErrors(const TrajectoryErrors& a, const TrajectoryErrors& b) {
  ExpectEqual(a.per_metre.translation, b.per_metre.translation);
  ExpectEqual(a.per_metre.rotation, b.per_metre.rotation);
  ExpectEqual(a.per_ten_metres.translation, b.per_ten_metres.translation);
  ExpectEqual(a.per_second.translation, b.per_second.translation);
  EXPECT_NEAR(a.path, b.path, kTolerance);
  EXPECT_NEAR(a.drift, b.drift, kTolerance);
}

void ExpectNoErrors(const TrajectoryErrors& errors, double tolerance = kTolerance) {
  EXPECT_NEAR(errors.position.max, 0.0, tolerance);
  EXPECT_NEAR(errors.yaw.max, 0.0, tolerance);
  EXPECT_NEAR(errors.final_position, 0.0, tolerance);
  EXPECT_NEAR(errors.per_metre.translation.max, 0.0, tolerance);
  EXPECT_NEAR(errors.per_second.rotation.max, 0.0, tolerance);
  EXPECT_NEAR(errors.drift, 0.0, tolerance);
}

TEST(EvaluateTrajectory, FindsNoErrorsInTheReference) {
  const TrajectoryErrors errors = Evaluate(Winding(), Winding(), Alignment::kNone);
  EXPECT_EQ(errors.poses, 401u);
  EXPECT_EQ(errors.matched, 401u);
  EXPECT_DOUBLE_EQ(errors.coverage, 1.0);
  EXPECT_GT(errors.per_metre.translation.count, 100u);
  ExpectNoErrors(errors);
}

TEST(EvaluateTrajectory, MeasuresAScaleErrorOfOnePercent) {
  const TrajectoryErrors errors = Evaluate(StraightLine(200), StraightLine(200, 1.01));
  EXPECT_NEAR(errors.path, 20.0, kTolerance);
  EXPECT_NEAR(errors.drift, 0.01, kTolerance);
  EXPECT_NEAR(errors.per_metre.translation.rms, 0.01, kTolerance);
  EXPECT_NEAR(errors.per_metre.translation.max, 0.01, kTolerance);
  EXPECT_NEAR(errors.per_ten_metres.translation.rms, 0.1, kTolerance);
  EXPECT_NEAR(errors.per_second.translation.rms, 0.01, kTolerance);
  EXPECT_EQ(errors.per_metre.translation.count, 191u);
  EXPECT_EQ(errors.per_ten_metres.translation.count, 101u);
  EXPECT_NEAR(errors.per_metre.rotation.max, 0.0, kTolerance);
  // Errors 0, 0.001, ... 0.2 m.
  EXPECT_NEAR(errors.position.mean, 0.1, kTolerance);
  EXPECT_NEAR(errors.position.median, 0.1, kTolerance);
  EXPECT_NEAR(errors.position.max, 0.2, kTolerance);
  EXPECT_NEAR(errors.final_position, 0.2, kTolerance);
  EXPECT_NEAR(errors.position.rms, 0.001 * std::sqrt(200.0 * 401.0 / 6.0), kTolerance);
}

TEST(EvaluateTrajectory, MeasuresAHeadingThatDrifts) {
  Trajectory estimate = StraightLine(100);
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    estimate[i].pose.theta = 0.1 * kDegree * static_cast<double>(i);
  }
  const TrajectoryErrors errors = Evaluate(StraightLine(100), estimate);
  EXPECT_NEAR(errors.per_metre.rotation.rms, 1.0 * kDegree, kTolerance);
  EXPECT_NEAR(errors.per_ten_metres.rotation.max, 10.0 * kDegree, kTolerance);
  EXPECT_NEAR(errors.per_second.rotation.max, 1.0 * kDegree, kTolerance);
  EXPECT_NEAR(errors.yaw.max, 10.0 * kDegree, kTolerance);
  EXPECT_NEAR(errors.yaw.mean, 5.0 * kDegree, kTolerance);
  EXPECT_NEAR(errors.final_yaw, 10.0 * kDegree, kTolerance);
}

TEST(EvaluateTrajectory, WrapsHeadingErrors) {
  const Trajectory reference{{0, {0, 0, M_PI - 0.01}}, {FromSeconds(1), {1, 0, M_PI - 0.01}}};
  const Trajectory estimate{{0, {0, 0, -M_PI + 0.01}}, {FromSeconds(1), {1, 0, -M_PI + 0.01}}};
  EXPECT_NEAR(Evaluate(reference, estimate, Alignment::kNone).yaw.max, 0.02, kTolerance);
}

TEST(EvaluateTrajectory, AlignmentUndoesAnotherFrame) {
  const Trajectory estimate = Moved({3.0, -7.0, 2.5}, Winding());
  ExpectNoErrors(Evaluate(Winding(), estimate, Alignment::kFirst));
  ExpectNoErrors(Evaluate(Winding(), estimate, Alignment::kBest));
  EXPECT_GT(Evaluate(Winding(), estimate, Alignment::kNone).position.rms, 1.0);
}

TEST(EvaluateTrajectory, DoesNotChangeWhenBothAreMoved) {
  const Pose2 motion{-12.0, 5.0, -2.0};
  for (const Alignment alignment : {Alignment::kFirst, Alignment::kBest, Alignment::kNone}) {
    const TrajectoryErrors still = Evaluate(Winding(), Winding(0.05), alignment);
    const TrajectoryErrors moved =
        Evaluate(Moved(motion, Winding()), Moved(motion, Winding(0.05)), alignment);
    ExpectEqual(still.position, moved.position);
    ExpectEqual(still.yaw, moved.yaw);
    ExpectEqualRelativeErrors(still, moved);
    EXPECT_GT(still.position.rms, 0.01);
  }
}

TEST(EvaluateTrajectory, RelativeErrorsDoNotDependOnTheFrame) {
  const TrajectoryErrors errors = Evaluate(Winding(), Winding(0.05), Alignment::kNone);
  ExpectEqualRelativeErrors(errors, Evaluate(Winding(), Moved({1.0, 2.0, 3.0}, Winding(0.05))));
  EXPECT_GT(errors.per_metre.translation.rms, 1e-3);
}

TEST(EvaluateTrajectory, BestAlignmentHasTheSmallestError) {
  const double best = Evaluate(Winding(), Winding(0.05), Alignment::kBest).position.rms;
  const Pose2 motion = Align(Associate(Winding(), Winding(0.05), 0.25), Alignment::kBest);
  for (const Pose2& step : {Pose2{1e-3, 0, 0}, Pose2{-1e-3, 0, 0}, Pose2{0, 1e-3, 0},
                            Pose2{0, -1e-3, 0}, Pose2{0, 0, 1e-3}, Pose2{0, 0, -1e-3}}) {
    const Trajectory other = Moved(step * motion, Winding(0.05));
    EXPECT_GT(Evaluate(Winding(), other, Alignment::kNone).position.rms, best);
  }
}

TEST(EvaluateTrajectory, BestAlignmentOfARobotAtRestUsesItsHeading) {
  const Trajectory reference{{0, {1.0, 2.0, 0.5}}, {FromSeconds(0.1), {1.0, 2.0, 0.5}}};
  const TrajectoryErrors errors =
      Evaluate(reference, Moved({4.0, 4.0, 3.0}, reference), Alignment::kBest);
  EXPECT_NEAR(errors.position.max, 0.0, kTolerance);
  EXPECT_NEAR(errors.yaw.max, 0.0, kTolerance);
  EXPECT_TRUE(std::isnan(errors.drift));  // no way, no drift per way
}

TEST(EvaluateTrajectory, InterpolatesTheReference) {
  Trajectory estimate;
  for (int i = 0; i < 100; ++i) {
    estimate.push_back({FromSeconds(0.1 * i + 0.03), {0.1 * i + 0.03, 0.0, 0.0}});
  }
  const TrajectoryErrors errors = Evaluate(StraightLine(100), estimate, Alignment::kNone);
  EXPECT_EQ(errors.matched, 100u);
  ExpectNoErrors(errors, 1e-8);  // stamps are whole nanoseconds
}

TEST(EvaluateTrajectory, LeavesOutWhatTheReferenceDoesNotKnow) {
  Trajectory reference = StraightLine(100);
  reference.erase(reference.begin() + 20, reference.begin() + 30);  // none from 2.0 s to 2.9 s
  Trajectory estimate = StraightLine(120);                          // 2 s longer than the reference
  const TrajectoryErrors errors = Evaluate(reference, estimate);
  EXPECT_EQ(errors.poses, 121u);
  EXPECT_EQ(errors.matched, 91u);
  ExpectNoErrors(errors);
}

TEST(EvaluateTrajectory, TellsHowMuchOfTheReferenceIsCovered) {
  EXPECT_NEAR(Evaluate(StraightLine(100), StraightLine(25)).coverage, 0.25, kTolerance);
}

TEST(EvaluateTrajectory, CountsAStandingRobotOnce) {
  // 60 s at rest, then 3 m with an error of 1 %, as on the whole way.
  Trajectory reference;
  Trajectory estimate;
  for (int i = 0; i < 630; ++i) {
    const double x = 0.1 * std::max(0, i - 599);
    reference.push_back({FromSeconds(0.1 * i), {x, 0.0, 0.0}});
    estimate.push_back({FromSeconds(0.1 * i), {1.01 * x, 0.0, 0.0}});
  }
  const TrajectoryErrors errors = Evaluate(reference, estimate);
  EXPECT_EQ(errors.per_metre.translation.count, 21u);
  EXPECT_NEAR(errors.per_metre.translation.rms, 0.01, kTolerance);
}

TEST(EvaluateTrajectory, LeavesOutWindowsOfTheWrongLength) {
  // Steps of 0.8 m: no window comes within a tenth of 1 m, but 12 or 13 steps come close to 10 m.
  Trajectory trajectory;
  for (int i = 0; i <= 20; ++i) trajectory.push_back({FromSeconds(i), {0.8 * i, 0.0, 0.0}});
  const TrajectoryErrors errors = Evaluate(trajectory, trajectory);
  EXPECT_EQ(errors.per_metre.translation.count, 0u);
  EXPECT_TRUE(std::isnan(errors.per_metre.translation.rms));
  EXPECT_EQ(errors.per_ten_metres.translation.count, 8u);
  EXPECT_EQ(errors.per_second.translation.count, 20u);
}

TEST(EvaluateTrajectory, TakesTheWindowOfTheNearestLength) {
  // Steps of 0.19 m: 0.95 m is near 1 m, 1.14 m is not.
  const TrajectoryErrors errors =
      Evaluate(StraightLine(20, 1.0, 0.19), StraightLine(20, 1.01, 0.19));
  EXPECT_EQ(errors.per_metre.translation.count, 15u);
  EXPECT_NEAR(errors.per_metre.translation.rms, 0.0095, kTolerance);
}

TEST(EvaluateTrajectory, FindsTheLastWindowWhateverTheRounding) {
  for (int steps = 1; steps <= 100; ++steps) {
    const Trajectory trajectory = StraightLine(steps, 1.0, 1.0 / steps);
    EXPECT_EQ(Evaluate(trajectory, trajectory).per_metre.translation.count, 1u) << steps;
  }
}

TEST(EvaluateTrajectory, SaysWhenTheTimesDoNotMeet) {
  Trajectory late = StraightLine(10);
  for (StampedPose& pose : late) pose.stamp += FromSeconds(100.0);
  try {
    Evaluate(StraightLine(10), late);
    FAIL() << "times that do not meet";
  } catch (const std::runtime_error& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("0 of 11 poses"), std::string::npos) << message;
    EXPECT_NE(message.find("from 0.000000000 to 1.000000000"), std::string::npos) << message;
    EXPECT_NE(message.find("from 100.000000000 to 101.000000000"), std::string::npos) << message;
  }
}

TEST(EvaluateTrajectory, RefusesNonsenseOptions) {
  TrajectoryErrorOptions options;
  options.max_gap = -1.0;
  EXPECT_THROW(EvaluateTrajectory(StraightLine(10), StraightLine(10), options),
               std::invalid_argument);
}

TEST(TrajectoryErrorsToKeyValues, GivesMetresDegreesAndPercent) {
  // 1 % too long, and turned by 1 degree from the second pose on. A window of length L that starts
  // there has the error L sqrt(1 + 1.01^2 - 2 * 1.01 cos(1 degree)), the first one 0.01 L.
  Trajectory estimate = StraightLine(200, 1.01);
  for (std::size_t i = 1; i < estimate.size(); ++i) estimate[i].pose.theta = 1.0 * kDegree;
  EXPECT_EQ(ToKeyValues(Evaluate(StraightLine(200), estimate)),
            "poses=201 matched=201 coverage_percent=100.000000 ate_rmse_m=0.115614 "
            "ate_mean_m=0.100000 ate_median_m=0.100000 ate_max_m=0.200000 ate_final_m=0.200000 "
            "yaw_rmse_deg=0.997509 yaw_mean_deg=0.995025 yaw_median_deg=1.000000 "
            "yaw_max_deg=1.000000 yaw_final_deg=1.000000 "
            "rpe_1m_rmse_m=0.020151 rpe_1m_max_m=0.020190 rpe_1m_yaw_rmse_deg=0.072357 "
            "rpe_1m_yaw_max_deg=1.000000 rpe_1m_pairs=191 "
            "rpe_10m_rmse_m=0.201149 rpe_10m_max_m=0.201905 rpe_10m_yaw_rmse_deg=0.099504 "
            "rpe_10m_yaw_max_deg=1.000000 rpe_10m_pairs=101 "
            "rpe_1s_rmse_m=0.020151 rpe_1s_max_m=0.020190 rpe_1s_yaw_rmse_deg=0.072357 "
            "rpe_1s_yaw_max_deg=1.000000 rpe_1s_pairs=191 "
            "path_m=20.000000 drift_percent=1.000000");
}

TEST(TrajectoryErrorsToKeyValues, WritesNanForAWayThatIsTooShort) {
  const std::string line = ToKeyValues(Evaluate(StraightLine(20), StraightLine(20)));
  EXPECT_NE(line.find("rpe_10m_rmse_m=nan"), std::string::npos) << line;
  EXPECT_NE(line.find("rpe_10m_pairs=0"), std::string::npos) << line;
  EXPECT_NE(line.find("rpe_1m_rmse_m=0.000000"), std::string::npos) << line;
}

}  // namespace
}  // namespace scan_image_slam
