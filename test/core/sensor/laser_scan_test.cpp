#include "scan_image_slam/core/sensor/laser_scan.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(LaserScan, BearingsGoOnByTheIncrement) {
  LaserScan scan;
  scan.angle_min = -1.0;
  scan.angle_increment = 0.25;
  EXPECT_DOUBLE_EQ(scan.Bearing(0), -1.0);
  EXPECT_DOUBLE_EQ(scan.Bearing(6), 0.5);
}

TEST(LaserScan, BearingsFallInAClockwiseSweep) {
  LaserScan scan;
  scan.angle_min = 1.0;
  scan.angle_increment = -0.25;
  EXPECT_DOUBLE_EQ(scan.Bearing(6), -0.5);
}

struct Case {
  double range;
  BeamReturn meaning;
};

/// REP-117 with range_min 0.1 m and range_max 30 m.
class Rep117 : public ::testing::TestWithParam<Case> {};

TEST_P(Rep117, TellsWhatARangeMeans) {
  EXPECT_EQ(Classify(GetParam().range, 0.1, 30.0), GetParam().meaning) << GetParam().range;
}

INSTANTIATE_TEST_SUITE_P(
    Table, Rep117,
    ::testing::Values(Case{5.0, BeamReturn::kHit},                 //
                      Case{0.1, BeamReturn::kHit},                 // the borders are obstacles
                      Case{30.0, BeamReturn::kHit},                //
                      Case{30.001, BeamReturn::kNoObject},         // some drivers: range_max + 1
                      Case{65.533, BeamReturn::kNoObject},         //
                      Case{kInfinity, BeamReturn::kNoObject},      //
                      Case{0.099, BeamReturn::kUnknown},           //
                      Case{0.001, BeamReturn::kUnknown},           // urg_node without intensity
                      Case{0.0, BeamReturn::kUnknown},             //
                      Case{-1.0, BeamReturn::kUnknown},            //
                      Case{-kInfinity, BeamReturn::kUnknown},      // REP-117: too near
                      Case{std::nan(""), BeamReturn::kUnknown}));  // REP-117: error

TEST(Classify, ZeroIsUnknownWhateverTheLimits) {
  EXPECT_EQ(Classify(0.0, 0.0, 30.0), BeamReturn::kUnknown);
}

TEST(Classify, InfinityIsNoObjectWhateverTheLimits) {
  EXPECT_EQ(Classify(kInfinity, 0.1, kInfinity), BeamReturn::kNoObject);
}

}  // namespace
}  // namespace scan_image_slam
