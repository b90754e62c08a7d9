#include "scan_image_slam/core/evaluation/map_quality.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

using Cells = std::vector<Eigen::Vector2i>;

/// 60 x 20 free cells of 5 cm from (0, 0) on, with some occupied ones.
MapImage MapWith(const Cells& occupied) {
  MapImage map;
  map.width = 60;
  map.height = 20;
  map.occupancy.assign(1200, 0);
  for (const Eigen::Vector2i& cell : occupied) map.occupancy[cell.y() * 60 + cell.x()] = 100;
  return map;
}

/// A wall of 2 m at y = 0.1, between the second and the third row of cells.
TruePlan OneWall() {
  TruePlan plan;
  plan.walls = {{{0.0, 0.1}, {2.0, 0.1}}};
  return plan;
}

MapQuality Judge(const MapImage& map, const TruePlan& plan,
                 const MapQualityOptions& options = MapQualityOptions()) {
  return EvaluateMap(map, plan, Pose2{}, options);
}

TEST(Precision, CountsCellsWhoseCentreIsNearAWall) {
  // Centres 2.5 cm below, 2.5 cm above and 7.5 cm above the wall.
  const MapQuality quality = Judge(MapWith({{5, 1}, {6, 2}, {7, 3}, {8, 2}}), OneWall());
  EXPECT_EQ(quality.right_cells, (Cells{{5, 1}, {6, 2}, {8, 2}}));
  EXPECT_EQ(quality.false_cells, (Cells{{7, 3}}));
  EXPECT_DOUBLE_EQ(quality.Precision(), 0.75);
}

TEST(Precision, FollowsTheTolerance) {
  MapQualityOptions options;
  options.tolerance = 0.076;
  EXPECT_DOUBLE_EQ(Judge(MapWith({{7, 3}}), OneWall(), options).Precision(), 1.0);
  options.tolerance = 0.074;
  EXPECT_DOUBLE_EQ(Judge(MapWith({{7, 3}}), OneWall(), options).Precision(), 0.0);
}

TEST(Precision, WallsEnd) {
  // Centres 2.5 cm and 7.5 cm beyond the end, both 2.5 cm aside.
  const MapQuality quality = Judge(MapWith({{40, 1}, {41, 1}}), OneWall());
  EXPECT_EQ(quality.right_cells, (Cells{{40, 1}}));
  EXPECT_EQ(quality.false_cells, (Cells{{41, 1}}));
}

TEST(Precision, TakesTheNearestWall) {
  TruePlan plan = OneWall();
  plan.walls.push_back({{0.0, 0.6}, {2.0, 0.6}});
  plan.walls.push_back({{0.0, 0.3}, {2.0, 0.3}});
  EXPECT_DOUBLE_EQ(Judge(MapWith({{5, 1}, {5, 6}, {5, 12}}), plan).Precision(), 1.0);
}

TEST(Precision, CellsAreOccupiedFromSixtyFivePercentOn) {
  MapImage map = MapWith({});
  map.occupancy[60 + 5] = 65;
  map.occupancy[60 + 6] = 64;
  map.occupancy[60 + 7] = -1;
  EXPECT_EQ(Judge(map, OneWall()).right_cells, (Cells{{5, 1}}));
}

TEST(Recall, CountsSeenPointsWithAnOccupiedCellNearby) {
  TruePlan plan = OneWall();
  // The centre of the cell is (0.275, 0.075): 4.6 cm, 5.1 cm and 1 m away.
  plan.seen = {{0.315, 0.0975}, {0.325, 0.085}, {1.275, 0.075}};
  const MapQuality quality = Judge(MapWith({{5, 1}}), plan);
  EXPECT_EQ(quality.seen, 3U);
  EXPECT_DOUBLE_EQ(quality.Recall(), 1.0 / 3.0);
  ASSERT_EQ(quality.missed.size(), 2U);
  EXPECT_NEAR((quality.missed[0] - plan.seen[1]).norm(), 0.0, 1e-12);
  EXPECT_NEAR((quality.missed[1] - plan.seen[2]).norm(), 0.0, 1e-12);
}

TEST(Recall, PointsOutsideTheMapAreMissed) {
  TruePlan plan = OneWall();
  plan.seen = {{-0.5, 0.1}, {0.1, -0.5}, {3.5, 0.1}, {0.1, 1.5}};
  EXPECT_DOUBLE_EQ(Judge(MapWith({{0, 0}, {59, 19}}), plan).Recall(), 0.0);
}

TEST(Recall, FindsTheCellOfItsEdgeFromOutside) {
  TruePlan plan = OneWall();
  plan.seen = {{-0.02, 0.025}};  // 4.5 cm from the centre of the first cell
  EXPECT_DOUBLE_EQ(Judge(MapWith({{0, 0}}), plan).Recall(), 1.0);
}

TEST(MapFrame, IsWhereItIsSaidToBe) {
  // The world is the map turned by 90 degrees to the left and moved by (10, 5).
  const Pose2 world_from_map{10.0, 5.0, M_PI_2};
  TruePlan plan;
  plan.walls = {{{9.9, 5.0}, {9.9, 7.0}}};
  plan.seen = {{9.9, 5.275}, {9.9, 6.5}};
  const MapQuality quality =
      EvaluateMap(MapWith({{5, 1}, {7, 3}}), plan, world_from_map, MapQualityOptions());
  EXPECT_EQ(quality.right_cells, (Cells{{5, 1}}));
  EXPECT_EQ(quality.false_cells, (Cells{{7, 3}}));
  ASSERT_EQ(quality.missed.size(), 1U);
  EXPECT_NEAR((quality.missed[0] - Eigen::Vector2d(1.5, 0.1)).norm(), 0.0, 1e-12);
}

TEST(Walls, AreMeasuredAcross) {
  // First metre: 2.5 cm to both sides, middle 0. Second: twice 7.5 cm to the same side.
  const MapQuality quality = Judge(MapWith({{0, 1}, {1, 2}, {30, 3}, {31, 3}}), OneWall());
  EXPECT_EQ(quality.walls.cells, 4U);
  EXPECT_NEAR(quality.walls.rms, std::sqrt((2 * 0.025 * 0.025 + 2 * 0.075 * 0.075) / 4), 1e-12);
  EXPECT_NEAR(quality.walls.thickness, std::sqrt(2 * 0.025 * 0.025 / 4), 1e-12);
  EXPECT_NEAR(quality.walls.offset, 2 * 0.075 / 4, 1e-12);
}

TEST(Walls, OffsetsToBothSidesDoNotCancel) {
  const MapQuality quality = Judge(MapWith({{0, 0}, {30, 3}}), OneWall());
  EXPECT_NEAR(quality.walls.offset, 0.075, 1e-12);
  EXPECT_NEAR(quality.walls.thickness, 0.0, 1e-12);
}

TEST(Walls, AreTheSameFromEitherEnd) {
  TruePlan plan = OneWall();
  const MapImage map = MapWith({{3, 1}, {4, 3}, {30, 3}, {31, 0}, {32, 2}});
  const WallFit fit = Judge(map, plan).walls;
  std::swap(plan.walls[0].from, plan.walls[0].to);
  const WallFit turned = Judge(map, plan).walls;
  EXPECT_NEAR(fit.rms, turned.rms, 1e-12);
  EXPECT_NEAR(fit.thickness, turned.thickness, 1e-12);
  EXPECT_NEAR(fit.offset, turned.offset, 1e-12);
}

TEST(Walls, FarCellsAreNoPartOfThem) {
  // Centres 22.5 cm and 27.5 cm above the wall.
  EXPECT_EQ(Judge(MapWith({{5, 6}}), OneWall()).walls.cells, 1U);
  EXPECT_EQ(Judge(MapWith({{5, 7}}), OneWall()).walls.cells, 0U);
}

TEST(Walls, CellsBeyondTheirEndsAreNoPartOfThem) {
  EXPECT_EQ(Judge(MapWith({{39, 1}, {40, 1}}), OneWall()).walls.cells, 1U);
  TruePlan plan;
  plan.walls = {{{1.0, 0.1}, {2.0, 0.1}}};
  EXPECT_EQ(Judge(MapWith({{19, 1}, {20, 1}}), plan).walls.cells, 1U);
}

TEST(Walls, ShortOnesKeepTheirCellsToThemselves) {
  TruePlan plan = OneWall();
  plan.walls.push_back({{0.5, 0.2}, {0.9, 0.2}});  // a box before the wall
  const MapQuality quality = Judge(MapWith({{12, 3}, {30, 3}}), plan);
  EXPECT_EQ(quality.walls.cells, 1U);
  EXPECT_NEAR(quality.walls.offset, 0.075, 1e-12);
}

TEST(MapQuality, SharesOfNothingDoNotExist) {
  const MapQuality quality = Judge(MapWith({}), OneWall());
  EXPECT_TRUE(std::isnan(quality.Precision()));
  EXPECT_TRUE(std::isnan(quality.Recall()));
  EXPECT_TRUE(std::isnan(quality.walls.rms));
  EXPECT_TRUE(std::isnan(quality.walls.thickness));
  EXPECT_TRUE(std::isnan(quality.walls.offset));
  EXPECT_TRUE(std::isnan(Judge(MapImage(), OneWall()).Precision()));
}

TEST(MapQuality, WithoutWallsEveryCellIsFalse) {
  EXPECT_DOUBLE_EQ(Judge(MapWith({{5, 1}}), TruePlan()).Precision(), 0.0);
}

TEST(MapQuality, IsOneLineOfKeysAndValues) {
  TruePlan plan = OneWall();
  plan.seen = {{0.275, 0.1}, {1.5, 0.1}};
  const MapQuality quality = Judge(MapWith({{5, 1}, {7, 3}}), plan);
  EXPECT_EQ(ToKeyValues(quality),
            "occupied_cells=2 precision_percent=50.000000 seen_points=2 "
            "recall_percent=50.000000 wall_cells=2 wall_rms_m=0.055902 "
            "wall_thickness_m=0.050000 wall_offset_m=0.025000");
}

TEST(MapQualityOptions, NamesTheFieldThatIsOutOfRange) {
  const auto error_of = [](const MapQualityOptions& options) -> std::string {
    try {
      options.Validate();
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "no error";
  };
  MapQualityOptions options;
  EXPECT_EQ(error_of(options), "no error");
  options.tolerance = 0.0;
  EXPECT_NE(error_of(options).find("tolerance"), std::string::npos);
  options = {};
  options.wall_distance = std::nan("");
  EXPECT_NE(error_of(options).find("wall_distance"), std::string::npos);
  options = {};
  options.occupied_from = 101;
  EXPECT_NE(error_of(options).find("occupied_from"), std::string::npos);
}

}  // namespace
}  // namespace scan_image_slam
