#include "scan_image_slam/core/matching/bounded_search.h"
#include "support_rooms.h"

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

using Cost = std::function<double(const ArcCoordinates&)>;

SearchResult Search(const SearchWindow& window, const SearchGrid& grid, bool lateral,
                    const Cost& cost) {
  return SearchExhaustively(MakeCandidates(window, grid, lateral), window, grid,
                            [&](const ArcCoordinates& d, double) { return cost(d); });
}

/// Brute force with another order and another rule: of the cheapest motions, one with the fewest
/// steps. `cheapest` is their cost.
struct Oracle {
  double cheapest = std::numeric_limits<double>::infinity();
  int steps = 0;

  Oracle(const SearchWindow& window, const SearchGrid& grid, bool lateral, const Cost& cost) {
    const auto count = [](double half, double step) {
      int n = 0;
      while (n * step < half - 1e-12) ++n;
      return n;
    };
    const int nd = count(window.half_distance, grid.distance_step);
    const int nl = lateral ? count(window.half_lateral, grid.distance_step) : 0;
    const int na = count(window.half_angle, grid.angle_step);
    const auto at = [](double half, int i, int n) { return n == 0 ? 0.0 : half * i / n; };
    for (int l = nl; l >= -nl; --l) {
      for (int d = nd; d >= -nd; --d) {
        for (int a = na; a >= -na; --a) {
          const int s = std::abs(l) + std::abs(d) + std::abs(a);
          const double c = cost({at(window.half_distance, d, nd), at(window.half_lateral, l, nl),
                                 at(window.half_angle, a, na)}) +
                           grid.deviation_cost * s;
          if (c > cheapest || (c == cheapest && s >= steps)) continue;
          cheapest = c;
          steps = s;
        }
      }
    }
  }
};

struct RandomProblem {
  SearchWindow window;
  SearchGrid grid;
  bool lateral;
  Cost cost;

  explicit RandomProblem(TestRandom* random) {
    window = {random->Uniform(0.0, 0.6), random->Uniform(0.0, 0.3), random->Uniform(0.0, 0.4)};
    grid = {random->Uniform(0.04, 0.2), random->Uniform(0.03, 0.2), random->Uniform(0.0, 0.02)};
    lateral = random->Index(2) == 0;
    const double d = random->Uniform(-0.8, 0.8), l = random->Uniform(-0.4, 0.4),
                 a = random->Uniform(-0.6, 0.6), ripple = random->Uniform(0.0, 0.3);
    const bool coarse = random->Index(2) == 0;  // whole tenths: many ties
    cost = [=](const ArcCoordinates& x) {
      const double smooth = std::abs(x.distance - d) + std::abs(x.lateral - l) +
                            std::abs(x.angle - a) + ripple * std::sin(30.0 * x.distance + x.angle);
      return coarse ? 0.125 * std::floor(8.0 * smooth) : smooth;
    };
  }
};

TEST(SearchExhaustively, FindsWhatBruteForceFinds) {
  TestRandom random(11);
  for (int i = 0; i < 400; ++i) {
    const RandomProblem p(&random);
    const SearchResult found = Search(p.window, p.grid, p.lateral, p.cost);
    const Oracle oracle(p.window, p.grid, p.lateral, p.cost);
    EXPECT_EQ(found.e, p.cost(found.deviation)) << i;
    const auto steps_of = [](double x, double half, double step) {
      return half > 0.0 ? std::lround(std::abs(x) / half * std::ceil(half / step)) : 0;
    };
    const long steps =
        steps_of(found.deviation.distance, p.window.half_distance, p.grid.distance_step) +
        steps_of(found.deviation.lateral, p.window.half_lateral, p.grid.distance_step) +
        steps_of(found.deviation.angle, p.window.half_angle, p.grid.angle_step);
    EXPECT_EQ(steps, oracle.steps) << i;
    EXPECT_NEAR(found.e + p.grid.deviation_cost * static_cast<double>(steps), oracle.cheapest,
                1e-12)
        << i;
  }
}

/// Compares a search that knows each cost with one that gives up at the limit, where `give_up` says
/// what it returns then.
void ExpectGivingUpChangesNothing(double (*give_up)(double limit)) {
  TestRandom random(12);
  for (int i = 0; i < 200; ++i) {
    const RandomProblem p(&random);
    const SearchResult full = Search(p.window, p.grid, p.lateral, p.cost);
    const SearchResult early =
        SearchExhaustively(MakeCandidates(p.window, p.grid, p.lateral), p.window, p.grid,
                           [&](const ArcCoordinates& d, double limit) {
                             const double e = p.cost(d);
                             return e < limit ? e : give_up(limit);
                           });
    ASSERT_EQ(early.e, full.e) << i;
    ASSERT_EQ(early.deviation.distance, full.deviation.distance) << i;
    ASSERT_EQ(early.deviation.lateral, full.deviation.lateral) << i;
    ASSERT_EQ(early.deviation.angle, full.deviation.angle) << i;
  }
}

TEST(SearchExhaustively, IsNotChangedByGivingUpEarly) {
  ExpectGivingUpChangesNothing([](double) { return std::numeric_limits<double>::infinity(); });
  ExpectGivingUpChangesNothing([](double limit) { return limit + 1e-9; });
}

TEST(SearchExhaustively, IsNotChangedByReturningTheLimit) {
  ExpectGivingUpChangesNothing([](double limit) { return limit; });
}

TEST(SearchExhaustively, TellsALimitThatAcceptsEachImprovement) {
  // The limit is what a candidate must stay below, its own deviation cost taken off.
  std::vector<double> limits;
  const SearchGrid grid{0.5, 1.0, 0.25};
  SearchExhaustively(MakeCandidates({0.5, 0.0, 0.0}, grid, false), {0.5, 0.0, 0.0}, grid,
                     [&](const ArcCoordinates&, double limit) {
                       limits.push_back(limit);
                       return 2.0;
                     });
  ASSERT_EQ(limits.size(), 3u);
  EXPECT_EQ(limits[0], std::numeric_limits<double>::infinity());
  EXPECT_DOUBLE_EQ(limits[1], 1.75);
  EXPECT_DOUBLE_EQ(limits[2], 1.75);
}

TEST(SearchExhaustively, KeepsThePredictionWhereNothingTellsMotionsApart) {
  for (const double deviation_cost : {0.0, 1e-4}) {
    const SearchResult found = Search({0.3, 0.2, 0.1}, {0.05, 0.02, deviation_cost}, true,
                                      [](const ArcCoordinates&) { return 0.7; });
    EXPECT_EQ(found.deviation.distance, 0.0);
    EXPECT_EQ(found.deviation.lateral, 0.0);
    EXPECT_EQ(found.deviation.angle, 0.0);
    EXPECT_EQ(found.e, 0.7);
    EXPECT_FALSE(found.on_window_edge);
  }
}

TEST(SearchExhaustively, WeighsTheDeviationAgainstTheFit) {
  // One step away e is 0.1 lower: worth a step that costs less, not one that costs more.
  const Cost cost = [](const ArcCoordinates& d) { return d.distance > 0.25 ? 0.9 : 1.0; };
  EXPECT_EQ(Search({0.5, 0, 0}, {0.5, 1.0, 0.09}, false, cost).deviation.distance, 0.5);
  EXPECT_EQ(Search({0.5, 0, 0}, {0.5, 1.0, 0.11}, false, cost).deviation.distance, 0.0);
}

TEST(SearchExhaustively, CountsItsCandidatesAndLeavesTheDeviationCostOutOfE) {
  const SearchResult found = Search({0.2, 0, 0.1}, {0.1, 0.1, 0.05}, false,
                                    [](const ArcCoordinates& d) { return 1.0 - d.distance; });
  EXPECT_EQ(found.candidates, 15);
  EXPECT_DOUBLE_EQ(found.deviation.distance, 0.2);
  EXPECT_DOUBLE_EQ(found.e, 0.8);
}

/// The motion nearest to a wanted one.
Cost DistanceTo(const ArcCoordinates& wanted) {
  return [wanted](const ArcCoordinates& d) {
    return std::abs(d.distance - wanted.distance) + std::abs(d.lateral - wanted.lateral) +
           std::abs(d.angle - wanted.angle);
  };
}

TEST(SearchExhaustively, ReportsABestMotionOnTheBorder) {
  const SearchWindow window{0.3, 0.2, 0.1};
  const SearchGrid grid{0.1, 0.05, 0.0};
  const auto on_edge = [&](const ArcCoordinates& wanted) {
    return Search(window, grid, true, DistanceTo(wanted)).on_window_edge;
  };
  EXPECT_TRUE(on_edge({9.0, 0.0, 0.0}));
  EXPECT_TRUE(on_edge({-0.29, 0.0, 0.0}));
  EXPECT_TRUE(on_edge({0.0, 0.0, 0.5}));
  EXPECT_TRUE(on_edge({0.0, 0.0, -0.1}));
  EXPECT_FALSE(on_edge({0.2, 0.0, 0.05}));
  EXPECT_FALSE(on_edge({-0.2, 0.2, -0.05}));
}

TEST(SearchExhaustively, DoesNotCallAShutWindowABorder) {
  EXPECT_FALSE(
      Search({0.0, 0.0, 0.0}, {0.1, 0.1, 0.0}, false, DistanceTo({1.0, 0.0, 1.0})).on_window_edge);
  EXPECT_FALSE(
      Search({0.2, 0.0, 0.0}, {0.1, 0.1, 0.0}, false, DistanceTo({0.1, 0.0, 1.0})).on_window_edge);
}

}  // namespace
}  // namespace scan_image_slam
