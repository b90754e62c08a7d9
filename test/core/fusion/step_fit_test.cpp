#include "scan_image_slam/core/fusion/step_fit.h"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

struct TrueStep {
  double column;
  double height;
};

/// What a lens with a Gaussian blur [px] makes of steps on a dark ground, in columns 0 to 14.
GreyProfile Blurred(const std::vector<TrueStep>& steps, double blur = 0.7) {
  GreyProfile profile;
  profile.stddev = 0.5;
  for (int x = 0; x < 15; ++x) {
    double level = 60.0;
    for (const TrueStep& step : steps) {
      level += 0.5 * step.height * std::erfc((step.column - x) / (blur * std::sqrt(2.0)));
    }
    profile.levels.push_back(level);
  }
  return profile;
}

TEST(FitFirstStep, FindsAStepWhereverItIsInItsPixel) {
  for (int i = 0; i <= 20; ++i) {
    const double column = 7.0 + 0.05 * i;
    for (const double height : {80.0, -80.0, 12.0}) {
      const auto step = FitFirstStep(Blurred({{column, height}}), {std::round(column)});
      ASSERT_TRUE(step) << column;
      EXPECT_NEAR(step->column, column, 0.01);
      EXPECT_NEAR(step->height, height, 0.02 * std::abs(height));
    }
  }
}

TEST(FitFirstStep, FindsItHoweverBlurredItIs) {
  for (const double blur : {0.45, 0.7, 1.0, 1.5}) {
    const auto step = FitFirstStep(Blurred({{7.3, 60.0}}, blur), {7.0});
    ASSERT_TRUE(step) << blur;
    EXPECT_NEAR(step->column, 7.3, 0.01) << blur;
  }
}

TEST(FitFirstStep, ShadingDoesNotMoveIt) {
  GreyProfile profile = Blurred({{7.3, 60.0}});
  for (std::size_t x = 0; x < profile.levels.size(); ++x) profile.levels[x] += 1.0 * x;
  const auto step = FitFirstStep(profile, {7.0});
  ASSERT_TRUE(step);
  EXPECT_NEAR(step->column, 7.3, 0.02);
}

/// The frame of a door: dark between two light surfaces. Each edge blurs into the other.
TEST(FitFirstStep, NeighboursDoNotPushItAside) {
  for (const double width : {4.0, 3.0, 2.0}) {
    const GreyProfile frame = Blurred({{7.2, -60.0}, {7.2 + width, 70.0}});
    const auto left = FitFirstStep(frame, {7.0, std::round(7.2 + width)});
    const auto right = FitFirstStep(frame, {std::round(7.2 + width), 7.0});
    ASSERT_TRUE(left && right) << width;
    EXPECT_NEAR(left->column, 7.2, 0.03) << width;
    EXPECT_NEAR(right->column, 7.2 + width, 0.03) << width;
    EXPECT_GT(left->height * right->height, -1e4);
    EXPECT_LT(left->height, 0.0);
    EXPECT_GT(right->height, 0.0);
  }
}

TEST(FitFirstStep, TheNearerANeighbourTheLessItKnows) {
  double before = 0.0;
  for (const double width : {6.0, 3.0, 1.5, 1.0}) {
    const auto step =
        FitFirstStep(Blurred({{7.2, -60.0}, {7.2 + width, 60.0}}), {7.0, 7.0 + width});
    ASSERT_TRUE(step) << width;
    EXPECT_GT(step->stddev, before) << width;
    before = step->stddev;
  }
}

TEST(FitFirstStep, AStepThatItWasNotToldOfMakesItUncertain) {
  const auto alone = FitFirstStep(Blurred({{7.2, 60.0}}), {7.0});
  const auto disturbed = FitFirstStep(Blurred({{7.2, 60.0}, {9.5, 40.0}}), {7.0});
  ASSERT_TRUE(alone && disturbed);
  EXPECT_GT(disturbed->stddev, 3.0 * alone->stddev);
}

/// Of many noisy profiles: the errors are what it says they are.
TEST(FitFirstStep, IsAsWrongAsItSays) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 2.0);
  double squares = 0.0;
  double said = 0.0;
  int found = 0;
  constexpr int kProfiles = 400;
  for (int i = 0; i < kProfiles; ++i) {
    const double column = 7.0 + 0.1 * (i % 10);
    GreyProfile profile = Blurred({{column, 40.0}});
    profile.stddev = 2.0;
    for (double& level : profile.levels) level += noise(random);
    const auto step = FitFirstStep(profile, {7.0});
    if (!step) continue;
    ++found;
    squares += std::pow(step->column - column, 2);
    said += std::pow(step->stddev, 2);
  }
  EXPECT_GT(found, 0.98 * kProfiles);
  EXPECT_GT(squares, 0.4 * said);
  EXPECT_LT(squares, 1.3 * said);
}

/// Two steps in one column can have any heights that together make the one that is seen.
TEST(FitFirstStep, KnowsItsUncertaintyIfAnotherIsSaidToBeInItsColumn) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, 2.0);
  int fitted = 0;
  for (int i = 0; i < 2000; ++i) {
    GreyProfile profile = Blurred({{7.3, 60.0}}, 0.35);
    profile.stddev = 1.0;
    for (double& level : profile.levels) level += noise(random);
    const auto step = FitFirstStep(profile, {7.3, 7.3 + 1e-4 * i});
    if (!step) continue;
    ++fitted;
    ASSERT_TRUE(std::isfinite(step->column)) << i;
    ASSERT_TRUE(std::isfinite(step->stddev)) << i;
  }
  EXPECT_GT(fitted, 0);
}

TEST(FitFirstStep, SaysNothingWithoutAStepOrOfTooFewLevels) {
  EXPECT_FALSE(FitFirstStep(Blurred({{7.2, 60.0}}), {}));
  EXPECT_FALSE(FitFirstStep({0, {1.0, 1.0, 9.0, 9.0}, 0.5}, {1.5}));
  EXPECT_FALSE(FitFirstStep(Blurred({}), {7.0}));
}

}  // namespace
}  // namespace scan_image_slam
