#include "scan_image_slam/core/matching/local_map_matcher.h"

#include "support_rooms.h"

#include <cmath>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

const Pose2 kOrigin;
constexpr SearchWindow kWindow{0.1, 0.05, 0.05};

/// A prediction that weighs next to nothing against the scan.
MotionPrediction Predicted(const Pose2& motion, const SearchWindow& window = kWindow) {
  MotionPrediction prediction;
  prediction.motion = motion;
  prediction.dt = 0.1;
  prediction.from_encoders = true;
  prediction.window = window;
  prediction.covariance = Eigen::Vector3d(100.0, 100.0, 100.0).asDiagonal();
  return prediction;
}

LocalMapMatcher StartedAt(const Pose2& pose, const LocalMapMatcherOptions& options = {}) {
  LocalMapMatcher matcher(options);
  matcher.Start(ModelOf(SeparateWalls(), pose, 0, TestLaser()), pose);
  return matcher;
}

FusedModel SeenFrom(const Pose2& pose) { return ModelOf(SeparateWalls(), pose, 1, TestLaser()); }

Pose2 Result(const Pose2& last, const MotionPrediction& prediction, const MatchOutcome& outcome) {
  return last * prediction.motion * FromArcCoordinates(outcome.deviation);
}

void ExpectPose(const Pose2& pose, const Pose2& expected, double distance, double angle) {
  const Pose2 error = expected.Inverse() * pose;
  EXPECT_LT(error.translation().norm(), distance);
  EXPECT_LT(std::abs(error.theta), angle);
}

TEST(LocalMapMatcher, FindsTheMotionBelowTheGridStep) {
  const Pose2 last{0.1, 0.2, 0.3};
  const Pose2 motion{0.123, 0.011, 0.037};
  LocalMapMatcherOptions options;
  options.refinement.along_gate =
      0.1;  // the end of a wall, seen for the first time, is near enough
  for (const Pose2& error : {Pose2{0.03, 0.01, 0.01}, Pose2{-0.04, -0.01, 0.02}, Pose2{}}) {
    LocalMapMatcher matcher = StartedAt(last, options);
    const MotionPrediction prediction = Predicted(motion * error);
    const MatchOutcome outcome = matcher.Match(SeenFrom(last * motion), last, prediction);
    ExpectPose(Result(last, prediction, outcome), last * motion, 1e-5, 1e-5);
    EXPECT_FALSE(outcome.on_window_edge);
    EXPECT_FALSE(outcome.degenerate);
    EXPECT_EQ(outcome.points, outcome.matched);
    EXPECT_LT(outcome.rms, 1e-5);
    EXPECT_LT(outcome.e, 0.05);
  }
}

TEST(LocalMapMatcher, SearchesTheWholeWindow) {
  // Far beyond what the refinement alone could reach.
  const SearchWindow wide{0.6, 0.1, 0.4};
  for (const Pose2& error :
       {Pose2{0.5, 0.0, 0.0}, Pose2{-0.5, 0.0, 0.0}, Pose2{0.0, 0.0, 0.3}, Pose2{0.0, 0.0, -0.3}}) {
    LocalMapMatcher matcher = StartedAt(kOrigin);
    const MotionPrediction prediction = Predicted(error, wide);
    const MatchOutcome outcome = matcher.Match(SeenFrom(kOrigin), kOrigin, prediction);
    ExpectPose(Result(kOrigin, prediction, outcome), kOrigin, 1e-4, 1e-4);
    EXPECT_EQ(outcome.candidates, 21 * 33);  // 0.6 / 0.06 and 0.4 / 0.025 on each side
  }
}

TEST(LocalMapMatcher, SearchesSidewaysOnlyWithoutEncoders) {
  const SearchWindow wide{0.06, 0.6, 0.015};
  const auto match = [&](bool from_encoders) {
    LocalMapMatcher matcher = StartedAt(kOrigin);
    MotionPrediction prediction = Predicted({0.0, 0.5, 0.0}, wide);
    prediction.from_encoders = from_encoders;
    return matcher.Match(SeenFrom(kOrigin), kOrigin, prediction);
  };
  const MatchOutcome without = match(false);
  EXPECT_EQ(without.candidates, 3 * 21 * 3);
  EXPECT_NEAR(without.deviation.lateral, -0.5, 1e-4);
  const MatchOutcome with_encoders = match(true);
  EXPECT_EQ(with_encoders.candidates, 3 * 3);
}

TEST(LocalMapMatcher, StaysInTheWindowWhateverWasPredicted) {
  TestRandom random(1);
  int on_edge = 0;
  for (int i = 0; i < 200; ++i) {
    const double scale = i % 2 == 0 ? 1.0 : 0.1;
    const Pose2 wrong{random.Uniform(-scale, scale), random.Uniform(-scale, scale),
                      random.Uniform(-scale, scale)};
    const SearchWindow window{random.Uniform(0.0, 0.2), random.Uniform(0.0, 0.1),
                              random.Uniform(0.0, 0.2)};
    MotionPrediction prediction = Predicted(wrong, window);
    prediction.from_encoders = random.Index(2) == 0;
    LocalMapMatcher matcher = StartedAt(kOrigin);
    const MatchOutcome outcome = matcher.Match(SeenFrom(kOrigin), kOrigin, prediction);
    EXPECT_TRUE(window.Contains(outcome.deviation)) << i;
    on_edge += outcome.on_window_edge ? 1 : 0;
  }
  EXPECT_GT(on_edge, 50);
}

TEST(LocalMapMatcher, ReportsAPredictionThatIsOffByMoreThanTheWindow) {
  for (const Pose2& error : {Pose2{0.12, 0.0, 0.0}, Pose2{-0.12, 0.0, 0.0}, Pose2{0.0, 0.0, 0.06},
                             Pose2{0.0, 0.0, -0.06}, Pose2{0.0, 0.06, 0.0}}) {
    LocalMapMatcher matcher = StartedAt(kOrigin);
    const MatchOutcome outcome = matcher.Match(SeenFrom(kOrigin), kOrigin, Predicted(error));
    EXPECT_TRUE(outcome.on_window_edge) << error.x << " " << error.y << " " << error.theta;
  }
}

TEST(LocalMapMatcher, WeighsThePredictionByItsCovariance) {
  // Told to be sure to a tenth of a millimetre, the prediction wins over the scan's millimetres.
  const auto match = [](double stddev) {
    LocalMapMatcherOptions options;
    options.prior_kernel = 1e6;
    options.filter.scale_stddev = 0.0;
    LocalMapMatcher matcher = StartedAt(kOrigin, options);
    MotionPrediction prediction = Predicted({0.02, 0.0, 0.0});
    prediction.covariance = Eigen::Matrix3d::Identity() * stddev * stddev;
    return matcher.Match(SeenFrom(kOrigin), kOrigin, prediction).deviation.distance;
  };
  EXPECT_NEAR(match(1e-5), 0.0, 1e-4);
  EXPECT_NEAR(match(1.0), -0.02, 1e-4);
}

TEST(LocalMapMatcher, KeepsThePredictionAlongAPlainCorridor) {
  TestLaser laser;
  laser.max_range = 10.0;
  LocalMapMatcher matcher{LocalMapMatcherOptions()};
  matcher.Start(ModelOf(PlainCorridor(), kOrigin, 0, laser), kOrigin);
  MotionPrediction prediction = Predicted({0.3, 0.02, 0.0});
  prediction.covariance = Eigen::Vector3d(0.01, 0.01, 0.01).asDiagonal();
  const MatchOutcome outcome =
      matcher.Match(ModelOf(PlainCorridor(), {0.35, 0.0, 0.0}, 1, laser), kOrigin, prediction);
  EXPECT_NEAR(outcome.deviation.distance, 0.0, 1e-3);
  EXPECT_NEAR(outcome.deviation.lateral, -0.02, 1e-3);
  EXPECT_TRUE(outcome.degenerate);
  EXPECT_LT(std::abs(std::sin(outcome.degenerate_direction)), 0.01);
  EXPECT_GT(outcome.covariance(0, 0), 10.0 * outcome.covariance(1, 1));
}

TEST(LocalMapMatcher, FollowsEdgesAlongAPlainCorridor) {
  TestLaser laser;
  laser.max_range = 10.0;
  const std::vector<RoomEdge> edges{
      {{1.0, 1.0}, 1}, {{1.9, 1.0}, -1}, {{0.6, -1.0}, 1}, {{-0.8, -1.0}, -1}};
  const auto seen_from = [&](double x) {
    FusedModel model = ModelOf(PlainCorridor(), {x, 0.0, 0.0}, 1, laser);
    model.edges = EdgesSeen(edges, {x, 0.0, 0.0}, 0.001);
    return model;
  };
  LocalMapMatcher matcher{LocalMapMatcherOptions()};
  matcher.Start(seen_from(0.0), kOrigin);
  matcher.Match(seen_from(0.0), kOrigin, Predicted(Pose2()));
  ASSERT_EQ(matcher.filter().edges(), 4);
  MotionPrediction prediction = Predicted({0.3, 0.0, 0.0});
  prediction.covariance = Eigen::Vector3d(0.01, 0.01, 0.01).asDiagonal();
  const MatchOutcome outcome = matcher.Match(seen_from(0.35), kOrigin, prediction);
  EXPECT_NEAR(outcome.deviation.distance, 0.05, 0.005);
  EXPECT_EQ(matcher.filter().edges(), 4);
  EXPECT_FALSE(outcome.degenerate);
}

TEST(LocalMapMatcher, CorrectsTheEdgesForATurnThatTheEncodersGotWrong) {
  constexpr double kWrong =
      0.005;  // what the encoders turned too far, between image and scan [rad]
  const std::vector<RoomEdge> edges{{{2.0, 3.0}, 1}, {{3.5, 2.0}, -1}, {{3.5, -1.0}, 1}};
  FusedModel model = SeenFrom(kOrigin);
  model.edges = EdgesSeen(edges, kOrigin, 0.001);
  LocalMapMatcher matcher = StartedAt(kOrigin);
  matcher.Match(model, kOrigin, Predicted(Pose2()));
  matcher.Match(model, kOrigin, Predicted(Pose2()));
  ASSERT_EQ(matcher.filter().edges(), 3);
  for (ModelEdge& edge : model.edges) {  // as the fusion brings them to the time of the scan
    edge.time_offset = -0.1;
    edge.bearing -= kWrong;
  }
  const MatchOutcome outcome = matcher.Match(model, kOrigin, Predicted({0.0, 0.0, kWrong}));
  ASSERT_EQ(CountMatched(outcome.edges), 3);
  for (const EdgeMatch& edge : outcome.edges) EXPECT_NEAR(edge.residual, 0.0, 0.05 * kWrong);
}

TEST(LocalMapMatcher, TellsWhatBecameOfEachEdge) {
  std::vector<ModelEdge> edges =
      EdgesSeen({{{1.0, 1.0}, 1}, {{1.9, 1.0}, -1}, {{0.6, -1.0}, 1}}, kOrigin, 0.001);
  edges[0].weight = 0.01;
  FusedModel model = ModelOf(PlainCorridor(), kOrigin, 1, TestLaser());
  LocalMapMatcher matcher{LocalMapMatcherOptions()};
  model.edges = {edges[0], edges[1]};
  matcher.Start(model, kOrigin);
  const auto uses = [&](const std::vector<ModelEdge>& seen) {
    model.edges = seen;
    std::vector<EdgeUse> told;
    for (const EdgeMatch& e : matcher.Match(model, kOrigin, Predicted(Pose2())).edges) {
      told.push_back(e.use);
    }
    return told;
  };
  const EdgeUse out = EdgeUse::kLeftOut;
  EXPECT_EQ(uses({edges[0], edges[1]}), (std::vector<EdgeUse>{out, EdgeUse::kNew}));
  EXPECT_EQ(uses({edges[2], edges[0], edges[1]}),
            (std::vector<EdgeUse>{EdgeUse::kNew, out, EdgeUse::kMatched}));
  EXPECT_EQ(uses({}), std::vector<EdgeUse>());
}

TEST(LocalMapMatcher, IsTheSameForBothSensesOfTheSweep) {
  const Pose2 motion{0.1, 0.0, 0.05};
  FusedModel reversed = SeenFrom(motion);
  std::reverse(reversed.beams.begin(), reversed.beams.end());
  LocalMapMatcher matcher = StartedAt(kOrigin);
  const MotionPrediction prediction = Predicted(motion * Pose2{0.02, 0.0, 0.01});
  const MatchOutcome outcome = matcher.Match(reversed, kOrigin, prediction);
  ExpectPose(Result(kOrigin, prediction, outcome), motion, 1e-5, 1e-5);
}

TEST(LocalMapMatcher, RefusesOptionsOutOfRange) {
  LocalMapMatcherOptions grid, refinement, map, edges;
  grid.grid.angle_step = 0.0;
  refinement.refinement.kernel = 0.0;
  map.local_map.spacing = 0.0;
  edges.filter.edges.gate = 0.0;
  for (const LocalMapMatcherOptions& options : {grid, refinement, map, edges}) {
    EXPECT_THROW(LocalMapMatcher{options}, std::invalid_argument);
  }
}

}  // namespace
}  // namespace scan_image_slam
