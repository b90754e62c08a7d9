#include "scan_image_slam/core/matching/frame_matcher.h"

#include "core/matching/frame_matcher_fixtures.h"
#include "support_rooms.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

TEST(FrameMatcher, FindsMotionsOfTheGridExactly) {
  const Pose2 predicted = Arc(0.04, 0.02);
  for (const ArcCoordinates& deviation :
       {ArcCoordinates{}, ArcCoordinates{0.02, 0.0, 0.0}, ArcCoordinates{-0.02, 0.0, 0.005},
        ArcCoordinates{0.01, 0.0, -0.01}, ArcCoordinates{-0.01, 0.0, 0.01}}) {
    const MatchOutcome outcome =
        MatchAfter(FurnishedRoom(), kPose, predicted * FromArcCoordinates(deviation), predicted);
    EXPECT_NEAR(outcome.deviation.distance, deviation.distance, 1e-12);
    EXPECT_NEAR(outcome.deviation.angle, deviation.angle, 1e-12);
    EXPECT_EQ(outcome.deviation.lateral, 0.0);
    EXPECT_FALSE(outcome.on_window_edge);
    EXPECT_EQ(outcome.candidates, 7 * 7);
    EXPECT_LT(outcome.e, 0.01);
  }
}

TEST(FrameMatcher, FindsTheWayBack) {
  const Pose2 motion = Arc(0.04, 0.02);
  const MatchOutcome outcome = MatchAfter(FurnishedRoom(), kPose * motion, motion.Inverse(),
                                          motion.Inverse() * Arc(-0.02, 0.01));
  EXPECT_NEAR(outcome.deviation.distance, 0.02, 1e-12);
  EXPECT_NEAR(outcome.deviation.angle, -0.01, 1e-12);
}

TEST(FrameMatcher, ReportsAPredictionThatIsOffByMoreThanTheWindow) {
  const MatchOutcome far = MatchAfter(FurnishedRoom(), kPose, {0.06, 0.0, 0.0}, Pose2());
  EXPECT_TRUE(far.on_window_edge);
  EXPECT_NEAR(far.deviation.distance, kWindow.half_distance, 1e-12);
  const MatchOutcome turned = MatchAfter(FurnishedRoom(), kPose, {0.0, 0.0, -0.05}, Pose2());
  EXPECT_TRUE(turned.on_window_edge);
  EXPECT_NEAR(turned.deviation.angle, -kWindow.half_angle, 1e-12);
}

TEST(FrameMatcher, StaysInTheWindowWhateverWasPredicted) {
  TestRandom random(1);
  for (int i = 0; i < 50; ++i) {
    const Pose2 wrong{random.Uniform(-1.0, 1.0), random.Uniform(-1.0, 1.0),
                      random.Uniform(-3.0, 3.0)};
    const MatchOutcome outcome = MatchAfter(FurnishedRoom(), kPose, Pose2(), wrong);
    EXPECT_LE(std::abs(outcome.deviation.distance), kWindow.half_distance * (1.0 + 1e-15));
    EXPECT_LE(std::abs(outcome.deviation.angle), kWindow.half_angle * (1.0 + 1e-15));
    EXPECT_EQ(outcome.deviation.lateral, 0.0);
  }
}

/// Points of the previous model that take part, of beams at -30 ... 30 degrees and at the back.
int PointsUsed(double laser_angle, bool upside_down) {
  std::vector<int> lit;
  for (int degree = -30; degree <= 30; ++degree) lit.push_back(degree);
  for (int degree = 150; degree < 180; ++degree) lit.push_back(degree);
  FusedModel model = ModelLitAt(lit);
  model.base_from_laser.theta = laser_angle;
  model.upside_down = upside_down;
  FrameMatcher matcher{FrameMatcherOptions()};
  matcher.Start(model);
  return matcher.Match(model, Predicted(Pose2())).points;
}

TEST(FrameMatcher, TakesTheFrontalPartByAngle) {
  EXPECT_EQ(PointsUsed(0.0, false), 51);                    // -25 ... 25
  EXPECT_EQ(PointsUsed(10.0 * M_PI / 180.0, false), 46);    // -30 ... 15
  EXPECT_EQ(PointsUsed(10.0 * M_PI / 180.0, true), 46);     // -15 ... 30
  EXPECT_EQ(PointsUsed(M_PI, false), 25);                   // 155 ... 179
  EXPECT_EQ(PointsUsed(170.0 * M_PI / 180.0, true), 30);    // 150 ... 179 -> 20 ... -9
  EXPECT_EQ(PointsUsed(-170.0 * M_PI / 180.0, false), 30);  // the same, the other way round
}

TEST(FrameMatcher, MatchesWithTheWiderPartOfTheCurrentModel) {
  // What was seen at 20 degrees is seen at 40 now: within the 100 degrees of the current model.
  FrameMatcher matcher(CoarseOptions());
  matcher.Start(ModelLitAt({20}));
  const double turn = -20.0 * M_PI / 180.0;
  const MatchOutcome inside = matcher.Match(ModelLitAt({40}), Predicted({0.0, 0.0, turn}));
  EXPECT_EQ(inside.points, 1);
  EXPECT_EQ(inside.matched, 1);
  EXPECT_NEAR(inside.e, 0.0, 1e-9);
  matcher.Start(ModelLitAt({24}));
  const MatchOutcome outside = matcher.Match(ModelLitAt({51}), Predicted({0.0, 0.0, 1.35 * turn}));
  EXPECT_EQ(outside.points, 1);
  EXPECT_EQ(outside.matched, 0);
  EXPECT_NEAR(outside.e, CoarseOptions().max_distance, 1e-12);
}

TEST(FrameMatcher, KeepsThePredictionWhereNothingIsSeen) {
  for (const bool before : {false, true}) {
    FrameMatcher matcher(CoarseOptions());
    matcher.Start(ModelLitAt(before ? std::vector<int>{0, 5} : std::vector<int>{}));
    const MatchOutcome outcome =
        matcher.Match(ModelLitAt(before ? std::vector<int>{} : std::vector<int>{0, 5}),
                      Predicted({0.02, 0.0, 0.01}));
    EXPECT_EQ(outcome.deviation.distance, 0.0);
    EXPECT_EQ(outcome.deviation.angle, 0.0);
    EXPECT_EQ(outcome.matched, 0);
    EXPECT_FALSE(outcome.on_window_edge);
  }
}

/// Ten plain points that have not moved, and `edges` others with edges that have come 20 mm nearer.
MatchOutcome MatchWithEdges(double edge_gain, int edges) {
  FusedModel previous = ModelLitAt({-20, -18, -16, -14, -12, -10, -8, -6, -4, -2, 10, 15, 20});
  FusedModel current = previous;
  int changed = 0;
  for (std::size_t i = 185; i < previous.beams.size(); ++i) {
    if (!previous.beams[i].hit()) continue;
    previous.beams[i].edge_weight = changed < edges ? 0.75 : 0.0;
    current.beams[i].point.x() -= 0.02;
    ++changed;
  }
  FrameMatcherOptions options = CoarseOptions();
  options.edge_gain = edge_gain;
  FrameMatcher matcher(options);
  matcher.Start(previous);
  return matcher.Match(current, Predicted(Pose2()));
}

TEST(FrameMatcher, FollowsTheEdgesIfTheyWeighMore) {
  // Weights 10 against 3 * (1 + gain * 0.75): the mean is least where the heavier group fits.
  const MatchOutcome plain = MatchWithEdges(0.0, 3);
  EXPECT_NEAR(plain.deviation.distance, 0.0, 1e-12);
  EXPECT_NEAR(plain.e, 3.0 * 0.02 / 13.0, 1e-12);
  const MatchOutcome with_edges = MatchWithEdges(4.0, 3);
  EXPECT_NEAR(with_edges.deviation.distance, 0.02, 1e-12);
  EXPECT_NEAR(with_edges.e, 10.0 * 0.02 / 22.0, 1e-12);
  EXPECT_NEAR(MatchWithEdges(4.0, 0).deviation.distance, 0.0, 1e-12);
}

TEST(FrameMatcher, MatchesEachModelWithTheOneBefore) {
  // 20 mm and 20 mm again: were the first one still the reference, the second would be 40 mm.
  FrameMatcher matcher(CoarseOptions());
  const Pose2 step{0.02, 0.0, 0.0};
  Pose2 pose = kPose;
  matcher.Start(ModelOf(FurnishedRoom(), pose, 0, PaperLaser()));
  for (int i = 1; i <= 3; ++i) {
    pose = pose * step;
    const auto outcome =
        matcher.Match(ModelOf(FurnishedRoom(), pose, i, PaperLaser()), Predicted(Pose2()));
    EXPECT_NEAR(outcome.deviation.distance, 0.02, 1e-12) << i;
  }
}

TEST(FrameMatcher, GivesTheSameBitsAgain) {
  const Pose2 motion = Arc(0.013, 0.003);
  const MatchOutcome a = MatchAfter(FurnishedRoom(), kPose, motion, Pose2());
  const MatchOutcome b = MatchAfter(FurnishedRoom(), kPose, motion, Pose2());
  EXPECT_EQ(a.deviation.distance, b.deviation.distance);
  EXPECT_EQ(a.deviation.angle, b.deviation.angle);
  EXPECT_EQ(a.e, b.e);
  EXPECT_EQ(a.covariance, b.covariance);
}

}  // namespace
}  // namespace scan_image_slam
