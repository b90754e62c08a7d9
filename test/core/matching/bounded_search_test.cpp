#include "scan_image_slam/core/matching/bounded_search.h"

#include "support_rooms.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

using Triple = std::tuple<double, double, double>;

Triple ToTriple(const ArcCoordinates& d) { return {d.distance, d.lateral, d.angle}; }

std::set<Triple> Deviations(const std::vector<Candidate>& candidates) {
  std::set<Triple> deviations;
  for (const Candidate& c : candidates) deviations.insert(ToTriple(c.deviation));
  return deviations;
}

TEST(MakeCandidates, MakesAGridByHand) {
  // 0.3 m in steps of at most 0.2 m are two of 0.15 m; 0.1 rad in steps of at most 0.1 rad is one.
  const std::vector<Candidate> candidates =
      MakeCandidates({0.3, 0.0, 0.125}, {0.2, 0.125, 0.0}, false);
  std::set<Triple> expected;
  for (const double d : {-0.3, -0.15, 0.0, 0.15, 0.3}) {
    for (const double a : {-0.125, 0.0, 0.125}) expected.insert({d, 0.0, a});
  }
  EXPECT_EQ(candidates.size(), 15u);
  EXPECT_EQ(Deviations(candidates), expected);
}

TEST(MakeCandidates, SearchesSidewaysOnlyIfAskedTo) {
  const SearchWindow window{0.25, 0.125, 0.0};
  for (const Candidate& c : MakeCandidates(window, {0.125, 0.01, 0.0}, false)) {
    EXPECT_EQ(c.deviation.lateral, 0.0);
  }
  const auto candidates = MakeCandidates(window, {0.125, 0.01, 0.0}, true);
  EXPECT_EQ(candidates.size(), 15u);
  EXPECT_EQ(Deviations(candidates).count({-0.25, 0.125, 0.0}), 1u);
  EXPECT_EQ(Deviations(candidates).count({0.25, -0.125, 0.0}), 1u);
}

TEST(MakeCandidates, KeepsThePredictionIfTheWindowIsShut) {
  const auto candidates = MakeCandidates({0.0, 0.0, 0.0}, {0.06, 0.015, 1e-4}, true);
  ASSERT_EQ(candidates.size(), 1u);
  EXPECT_EQ(ToTriple(candidates[0].deviation), Triple(0.0, 0.0, 0.0));
  EXPECT_EQ(candidates[0].steps, 0);
}

TEST(MakeCandidates, CountsTheStepsToThePrediction) {
  for (const Candidate& c : MakeCandidates({0.5, 0.25, 0.75}, {0.25, 0.25, 0.0}, true)) {
    const double steps = (std::abs(c.deviation.distance) + std::abs(c.deviation.lateral) +
                          std::abs(c.deviation.angle)) /
                         0.25;
    EXPECT_EQ(c.steps, static_cast<int>(std::lround(steps)));
  }
}

/// Windows and grids of a few steps on each axis, some of them shut.
struct RandomSearch {
  SearchWindow window;
  SearchGrid grid;
  bool lateral;

  explicit RandomSearch(TestRandom* random) {
    const auto half = [&](double scale) {
      return random->Index(8) == 0 ? 0.0 : random->Uniform(0.0, scale);
    };
    window = {half(0.5), half(0.3), half(0.4)};
    grid.distance_step = random->Uniform(0.05, 0.3);
    grid.angle_step = random->Uniform(0.03, 0.3);
    grid.deviation_cost = random->Index(3) == 0 ? 0.0 : random->Uniform(0.0, 0.05);
    lateral = random->Index(2) == 0;
  }
  std::vector<Candidate> Candidates() const { return MakeCandidates(window, grid, lateral); }
};

/// The values of one coordinate over all candidates, in order.
std::vector<double> Axis(const std::vector<Candidate>& candidates, double ArcCoordinates::*axis) {
  std::set<double> values;
  for (const Candidate& c : candidates) values.insert(c.deviation.*axis);
  return {values.begin(), values.end()};
}

void ExpectEvenAxis(const std::vector<double>& values, double half, double step) {
  EXPECT_NEAR(values.front(), -half, 1e-15);
  EXPECT_NEAR(values.back(), half, 1e-15);
  EXPECT_TRUE(std::binary_search(values.begin(), values.end(), 0.0));
  for (std::size_t i = 1; i < values.size(); ++i) {
    EXPECT_LE(values[i] - values[i - 1], step + 1e-15);
  }
  if (values.size() > 3) {  // and not one step more than needed
    EXPECT_GT(half / static_cast<double>(values.size() / 2 - 1), step - 1e-15);
  }
}

TEST(MakeCandidates, CoversTheWindowWithStepsNoLargerThanTheGrids) {
  TestRandom random(1);
  for (int i = 0; i < 300; ++i) {
    const RandomSearch search(&random);
    const auto candidates = search.Candidates();
    const auto d = Axis(candidates, &ArcCoordinates::distance);
    const auto l = Axis(candidates, &ArcCoordinates::lateral);
    const auto a = Axis(candidates, &ArcCoordinates::angle);
    ExpectEvenAxis(d, search.window.half_distance, search.grid.distance_step);
    ExpectEvenAxis(l, search.lateral ? search.window.half_lateral : 0.0, search.grid.distance_step);
    ExpectEvenAxis(a, search.window.half_angle, search.grid.angle_step);
    EXPECT_EQ(candidates.size(), d.size() * l.size() * a.size());
    EXPECT_EQ(Deviations(candidates).size(), candidates.size());
  }
}

TEST(MakeCandidates, StartsAtThePredictionAndGoesOutwards) {
  TestRandom random(2);
  for (int i = 0; i < 100; ++i) {
    const auto candidates = RandomSearch(&random).Candidates();
    EXPECT_EQ(ToTriple(candidates[0].deviation), Triple(0.0, 0.0, 0.0));
    EXPECT_TRUE(
        std::is_sorted(candidates.begin(), candidates.end(),
                       [](const Candidate& x, const Candidate& y) { return x.steps < y.steps; }));
  }
}

TEST(MakeCandidates, HasNothingOutsideTheWindow) {
  TestRandom random(3);
  for (int i = 0; i < 2000; ++i) {
    const RandomSearch search(&random);
    for (const Candidate& c : search.Candidates()) {
      ASSERT_TRUE(search.window.Contains(c.deviation)) << "window " << i;
    }
  }
}

TEST(SearchGrid, NamesTheStepThatIsWrong) {
  const auto complaint = [](SearchGrid grid) -> std::string {
    try {
      grid.Validate();
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(complaint({}), "");
  EXPECT_EQ(complaint({0.1, 0.1, 0.0}), "");
  const double infinite = std::numeric_limits<double>::infinity();
  for (const double wrong : {0.0, -1.0, std::nan(""), infinite}) {
    EXPECT_EQ(complaint({wrong, 0.1, 0.0}).find("distance_step"), 0u);
    EXPECT_EQ(complaint({0.1, wrong, 0.0}).find("angle_step"), 0u);
  }
  for (const double wrong : {-1.0, std::nan(""), infinite}) {
    EXPECT_EQ(complaint({0.1, 0.1, wrong}).find("deviation_cost"), 0u);
  }
}

}  // namespace
}  // namespace scan_image_slam
