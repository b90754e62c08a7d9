#include "scan_image_slam/core/fusion/scan_model.h"

#include "support_fusion.h"
#include "support_options.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

/// A room around the origin, in which no two bearings see the same range.
PaintedWorld Room() {
  PaintedWorld world;
  world.AddWall({4, -3}, {3, 5});
  world.AddWall({3, 5}, {-5, 2});
  world.AddWall({-5, 2}, {-4, -6});
  world.AddWall({-4, -6}, {4, -3});
  return world;
}

/// The UTM-30LX: beams every 0.25 degrees, from index `first` to `last` of its 1081.
LaserScan Utm30(int first = 0, int last = 1080) {
  return Room().Scan({}, (-135.0 + 0.25 * first) * kDegree, 0.25 * kDegree, last - first + 1);
}

FusedModel MakeModel(const LaserScan& scan, const ScanModelOptions& options = {},
                     const LaserMount& mount = {}) {
  return MakeScanModel(scan, mount, {}, options);
}

ScanModelOptions FieldOfView(double degrees, double spacing_degrees = 0.0) {
  ScanModelOptions options;
  options.field_of_view = degrees * kDegree;
  options.min_beam_spacing = spacing_degrees * kDegree;
  return options;
}

void ExpectSameBeams(const FusedModel& a, const FusedModel& b) {
  ASSERT_EQ(a.beams.size(), b.beams.size());
  for (std::size_t i = 0; i < a.beams.size(); ++i) {
    EXPECT_NEAR(a.beams[i].bearing, b.beams[i].bearing, 1e-12);
    EXPECT_NEAR((a.beams[i].point - b.beams[i].point).norm(), 0.0, 1e-5);
  }
}

TEST(ScanModelOptions, NamesTheFieldThatIsWrong) {
  EXPECT_NO_THROW(ScanModelOptions().Validate());
  for (const double nonsense : {-0.1, std::nan("")}) {
    ExpectRefused(&ScanModelOptions::min_range, nonsense, "min_range");
    ExpectRefused(&ScanModelOptions::max_range, nonsense, "max_range");
    ExpectRefused(&ScanModelOptions::field_of_view, nonsense, "field_of_view");
    ExpectRefused(&ScanModelOptions::min_beam_spacing, nonsense, "min_beam_spacing");
  }
  ExpectRefused(&ScanModelOptions::max_range, 0.05, "max_range");  // as min_range
  ExpectRefused(&ScanModelOptions::field_of_view, 0.0, "field_of_view");
}

TEST(MakeScanModel, TakesEveryBeamByDefault) {
  const LaserScan scan = Utm30();
  const FusedModel model = MakeModel(scan);
  ASSERT_EQ(model.beams.size(), 1081U);
  for (std::size_t i = 0; i < model.beams.size(); ++i) {
    EXPECT_DOUBLE_EQ(model.beams[i].bearing, scan.Bearing(i));
    EXPECT_FLOAT_EQ(static_cast<float>(model.beams[i].range), scan.ranges[i]);
  }
}

TEST(MakeScanModel, OneHundredDegreesAre400BeamsOfAQuarterDegree) {
  // Beams at -49.875, -49.625, ... 49.875 degrees.
  const LaserScan scan = Room().Scan({}, -134.875 * kDegree, 0.25 * kDegree, 1080);
  const FusedModel model = MakeModel(scan, FieldOfView(100.0, 0.25));
  ASSERT_EQ(model.beams.size(), 400U);
  EXPECT_NEAR(model.beams.front().bearing, -49.875 * kDegree, 1e-12);
  EXPECT_NEAR(model.beams.back().bearing, 49.875 * kDegree, 1e-12);
}

TEST(MakeScanModel, SelectsByAngleHoweverTheDriverCutsTheScan) {
  // The limits lie between two beams.
  const FusedModel whole = MakeModel(Utm30(), FieldOfView(100.1));
  EXPECT_EQ(whole.beams.size(), 401U);
  ExpectSameBeams(MakeModel(Utm30(180, 900), FieldOfView(100.1)), whole);  // urg_node: +-90
  ExpectSameBeams(MakeModel(Utm30(301, 777), FieldOfView(100.1)), whole);
}

TEST(MakeScanModel, ACutInsideTheFieldOfViewLeavesWhatThereIs) {
  const FusedModel model = MakeModel(Utm30(400, 600), FieldOfView(100.1));
  ASSERT_EQ(model.beams.size(), 201U);
  EXPECT_NEAR(model.beams.front().bearing, -35.0 * kDegree, 1e-12);
}

TEST(MakeScanModel, BearingsBeyondPiAreInFrontToo) {
  const LaserScan scan = Room().Scan({}, 0.5 * kDegree, kDegree, 360);  // 0.5 to 359.5 degrees
  const FusedModel model = MakeModel(scan, FieldOfView(90.0));
  ASSERT_EQ(model.beams.size(), 90U);
  EXPECT_NEAR(model.beams[44].bearing, 44.5 * kDegree, 1e-12);
  EXPECT_NEAR(model.beams[45].bearing, 315.5 * kDegree, 1e-12);
  const double range = Room().Range({0, 0}, -44.5 * kDegree);
  EXPECT_NEAR(model.beams[45].point.y(), range * std::sin(-44.5 * kDegree), 1e-5);
}

TEST(MakeScanModel, TheFieldOfViewIsAroundTheRobotsFront) {
  LaserMount mount;
  mount.base_from_laser.theta = 90.0 * kDegree;
  const FusedModel model = MakeModel(Utm30(), FieldOfView(20.1), mount);
  ASSERT_EQ(model.beams.size(), 81U);
  EXPECT_NEAR(model.beams.front().bearing, -100.0 * kDegree, 1e-12);
}

TEST(MakeScanModel, LeavesOutBeamsThatAreTooDense) {
  const LaserScan scan = Room().Scan({}, -1.0, 0.125 * kDegree, 9);
  const FusedModel model = MakeModel(scan, FieldOfView(360.0, 0.3));  // so every third
  ASSERT_EQ(model.beams.size(), 3U);
  EXPECT_NEAR(model.beams[1].bearing, -1.0 + 0.375 * kDegree, 1e-12);
  EXPECT_NEAR(model.beams[2].bearing, -1.0 + 0.75 * kDegree, 1e-12);
}

TEST(MakeScanModel, KeepsBeamsAtExactlyTheSpacingInSinglePrecision) {
  LaserScan scan = Utm30();
  scan.angle_min = static_cast<float>(scan.angle_min);
  scan.angle_increment = static_cast<float>(scan.angle_increment);
  EXPECT_EQ(MakeModel(scan, FieldOfView(360.0, 0.25)).beams.size(), 1081U);
}

struct Coding {
  double range;
  double expected;  ///< NaN: unknown
};
class RangeCoding : public ::testing::TestWithParam<Coding> {};

TEST_P(RangeCoding, FollowsRep117AndTheLimits) {
  LaserScan scan;  // 0.1 to 30 m
  scan.range_min = 0.1;
  scan.range_max = 30.0;
  scan.angle_increment = kDegree;
  scan.ranges = {1.0f, static_cast<float>(GetParam().range), 1.0f};
  ScanModelOptions options;
  options.min_range = 0.5;
  options.max_range = 20.0;
  const FusedModel model = MakeModel(scan, options);
  ASSERT_EQ(model.beams.size(), 3U);  // beams without a hit keep their place
  const double range = model.beams[1].range;
  if (std::isnan(GetParam().expected)) {
    EXPECT_TRUE(std::isnan(range)) << range;
  } else {
    EXPECT_EQ(range, GetParam().expected);
  }
}

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr double kNoObject = std::numeric_limits<double>::infinity();

INSTANTIATE_TEST_SUITE_P(Table, RangeCoding,
                         ::testing::Values(Coding{5.0, 5.0},              //
                                           Coding{0.5, 0.5},              // limits are inside
                                           Coding{20.0, 20.0},            //
                                           Coding{0.25, kUnknown},        // the robot itself
                                           Coding{25.0, kUnknown},        // not to be used
                                           Coding{30.5, kNoObject},       //
                                           Coding{kNoObject, kNoObject},  //
                                           Coding{kUnknown, kUnknown},    //
                                           Coding{-kNoObject, kUnknown},  //
                                           Coding{0.0, kUnknown},         //
                                           Coding{0.001, kUnknown}));     // urg_node

}  // namespace
}  // namespace scan_image_slam
