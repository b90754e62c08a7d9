// Which scans the mapper draws, and what of them.
#include "mapper_fixtures.h"
#include "scan_image_slam/core/mapping/mapper.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Cells of 1 m, whose lower left corners are whole numbers.
MapperOptions MetreMap() {
  MapperOptions options;
  options.grid.resolution = 1.0;
  options.grid.max_range = 10.0;
  options.map_update_distance_thresh = 0.5;
  options.map_update_angle_thresh = 0.2;
  options.map_update_time_thresh = 3.0;
  return options;
}

/// Without encoders, so that the base begins at the origin of the map: in the middle of a cell, if
/// seen from half a metre further.
constexpr double kHalf = 0.5;

void Draw(Mapper* mapper, const FusedModel& model, const MatchedMotion& match) {
  mapper->AddMatch(match);
  mapper->AddModel(model, match);
}

/// The mapper at (0.5, 0.5).
Mapper Begun(const MapperOptions& options) {
  Mapper mapper(options);
  mapper.AddMatch(MatchAt(0, 0, {}, Pose2{kHalf, kHalf, 0.0}));
  return mapper;
}

TEST(MapDrawing, PutsTheScanWhereTheBaseIs) {
  Mapper mapper = Begun(MetreMap());
  Draw(&mapper, WallAhead(2.0), MatchAt(0, 1, {3.0, 1.0, M_PI_2}));  // at (3.5, 1.5), along y
  EXPECT_EQ(mapper.grid().Occupancy(3, 3), 75);
  EXPECT_EQ(mapper.grid().Occupancy(3, 2), 40);
  EXPECT_EQ(mapper.grid().Occupancy(3, 1), 40);
  EXPECT_EQ(DrawnCells(mapper), 3);
}

TEST(MapDrawing, RaysStartAtTheLaser) {
  Mapper mapper = Begun(MetreMap());
  FusedModel model = WallAhead(2.0);
  model.base_from_laser = {1.0, 0.0, 0.0};
  model.beams[0].point = {3.0, 0.0};
  Draw(&mapper, model, MatchAt(0, 0, {}));
  EXPECT_EQ(mapper.grid().Occupancy(0, 0), -1);
  EXPECT_EQ(mapper.grid().Occupancy(1, 0), 40);
  EXPECT_EQ(mapper.grid().Occupancy(3, 0), 75);
}

TEST(MapDrawing, MovesPointsByWhatTheEncodersWereWrongBy) {
  Mapper mapper = Begun(MetreMap());
  FusedModel model = WallAhead(2.0);
  model.beams[0].time_offset = 0.5;
  MatchedMotion match = MatchAt(0, 0, {});
  match.sweep_correction = {0.0, 4.0, 0.0};  // to the left, 2 m until the beam was fired
  Draw(&mapper, model, match);
  EXPECT_EQ(mapper.grid().Occupancy(2, 2), 75);
}

/// True if a second scan is drawn after such a motion and time.
bool DrawnAfter(const Pose2& motion, double seconds, MatchStatus status = MatchStatus::kMatched) {
  Mapper mapper = Begun(MetreMap());
  Draw(&mapper, WallAhead(2.0), MatchAt(0, 0, {}));
  MatchedMotion match = MatchAt(0, FromSeconds(seconds), motion);
  match.status = status;
  const int before = DrawnCells(mapper);
  Draw(&mapper, WallAhead(8.0), match);
  return DrawnCells(mapper) > before;
}

TEST(MapDrawing, TakesAScanWhenTheRobotHasMoved) {
  EXPECT_FALSE(DrawnAfter({0.49, 0.0, 0.0}, 0.1));
  EXPECT_TRUE(DrawnAfter({0.51, 0.0, 0.0}, 0.1));
  EXPECT_TRUE(DrawnAfter({0.0, -0.51, 0.0}, 0.1));
}

TEST(MapDrawing, TakesAScanWhenTheRobotHasTurned) {
  EXPECT_FALSE(DrawnAfter({0.0, 0.0, -0.19}, 0.1));
  EXPECT_TRUE(DrawnAfter({0.0, 0.0, 0.21}, 0.1));
  EXPECT_TRUE(DrawnAfter({0.0, 0.0, -0.21}, 0.1));
}

TEST(MapDrawing, TakesAScanWhenTimeHasPassed) {
  EXPECT_FALSE(DrawnAfter({}, 2.9));
  EXPECT_TRUE(DrawnAfter({}, 3.1));
}

TEST(MapDrawing, MeasuresFromTheLastScanThatWasDrawn) {
  Mapper mapper = Begun(MetreMap());
  Draw(&mapper, WallAhead(2.0), MatchAt(0, 0, {}));
  for (const double x : {0.2, 0.4}) Draw(&mapper, WallAhead(8.0), MatchAt(0, 1, {x, 0.0, 0.0}));
  EXPECT_EQ(DrawnCells(mapper), 3);
  Draw(&mapper, WallAhead(8.0), MatchAt(0, 2, {0.6, 0.0, 0.0}));
  EXPECT_GT(DrawnCells(mapper), 3);
  const std::int8_t before = mapper.grid().Occupancy(1, 0);
  Draw(&mapper, WallAhead(8.0), MatchAt(0, 3, {0.9, 0.0, 0.0}));
  EXPECT_EQ(mapper.grid().Occupancy(1, 0), before);
}

TEST(MapDrawing, LeavesOutAScanWhosePlaceIsWrong) {
  EXPECT_FALSE(DrawnAfter({2.0, 0.0, 0.0}, 5.0, MatchStatus::kOnWindowEdge));
  EXPECT_TRUE(DrawnAfter({2.0, 0.0, 0.0}, 5.0, MatchStatus::kDegenerate));
}

struct NoReturnCase {
  double range;  ///< as the model codes it
  NoReturnPolicy policy;
  int free;  ///< cells cleared, the first at the laser
  int hits;
};

class NoReturn : public ::testing::TestWithParam<NoReturnCase> {};

TEST_P(NoReturn, ClearsWhatThePolicySays) {
  MapperOptions options = MetreMap();
  options.grid.no_return_policy = GetParam().policy;
  Mapper mapper = Begun(options);
  FusedModel model = WallAhead(GetParam().range);
  if (!model.beams[0].hit()) model.beams[0].point = {0.0, 0.0};
  Draw(&mapper, model, MatchAt(0, 0, {}));
  int free = 0;
  int hits = 0;
  for (int x = 0; x < 40; ++x) {
    free += mapper.grid().Occupancy(x, 0) == 40;
    hits += mapper.grid().Occupancy(x, 0) == 75;
  }
  EXPECT_EQ(free, GetParam().free);
  EXPECT_EQ(hits, GetParam().hits);
  EXPECT_EQ(DrawnCells(mapper), free + hits);
}

constexpr NoReturnPolicy kIgnore = NoReturnPolicy::kIgnore;
constexpr NoReturnPolicy kClear = NoReturnPolicy::kClearToMax;
constexpr NoReturnPolicy kLegacy = NoReturnPolicy::kClearToMaxLegacy;

// The map reaches 10 m, so that a beam from 0.5 m on ends in the eleventh cell.
INSTANTIATE_TEST_SUITE_P(
    Table, NoReturn,
    ::testing::Values(NoReturnCase{kInfinity, kIgnore, 0, 0},  //
                      NoReturnCase{kInfinity, kClear, 10, 0},  // REP-117: nothing within reach
                      NoReturnCase{kInfinity, kLegacy, 10, 0},
                      NoReturnCase{kNan, kIgnore, 0, 0},  //
                      NoReturnCase{kNan, kClear, 0, 0},   // REP-117: an error says nothing
                      NoReturnCase{kNan, kLegacy, 10, 0},
                      // A wall too far for the map is no wall in it, but the way there is free.
                      NoReturnCase{25.0, kIgnore, 10, 0},  //
                      NoReturnCase{25.0, kClear, 10, 0},   //
                      NoReturnCase{3.0, kIgnore, 3, 1},    //
                      NoReturnCase{3.0, kLegacy, 3, 1}));

TEST(MapDrawing, FreeBeamsOfALaserUpsideDownLieOnTheirSide) {
  MapperOptions options = MetreMap();
  options.grid.no_return_policy = kClear;
  Mapper mapper = Begun(options);
  FusedModel model = WallAhead(kInfinity);
  model.upside_down = true;
  model.beams[0].bearing = M_PI_2;  // to the right
  Draw(&mapper, model, MatchAt(0, 0, {}));
  EXPECT_EQ(mapper.grid().Occupancy(0, -5), 40);
  EXPECT_EQ(mapper.grid().Occupancy(0, 5), -1);
}

TEST(MapperOptions, NamesTheFieldThatIsOutOfRange) {
  const auto error_of = [](double MapperOptions::*field, double value) -> std::string {
    MapperOptions options;
    options.*field = value;
    try {
      Mapper mapper(options);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  const std::pair<double MapperOptions::*, std::string> fields[] = {
      {&MapperOptions::map_update_distance_thresh, "map_update_distance_thresh"},
      {&MapperOptions::map_update_angle_thresh, "map_update_angle_thresh"},
      {&MapperOptions::map_update_time_thresh, "map_update_time_thresh"}};
  for (const auto& [field, name] : fields) {
    for (const double value : {-0.1, kNan, kInfinity}) {
      EXPECT_EQ(error_of(field, value).find(name), 0U) << name << " " << value;
    }
    EXPECT_EQ(error_of(field, 0.0), "") << name;
  }
  MapperOptions nothing;
  nothing.max_scans_per_place = 0;
  EXPECT_THROW(Mapper{nothing}, std::invalid_argument);
}

}  // namespace
}  // namespace scan_image_slam
