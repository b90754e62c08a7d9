#include "scan_image_slam/core/matching/search_window.h"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

/// Powers of ten, so that each term can be told in a sum.
MotionBounds DecimalBounds() {
  MotionBounds bounds;
  bounds.distance_per_distance = 0.1;
  bounds.distance_per_angle = 0.01;
  bounds.distance_per_time = 0.001;
  bounds.min_distance = 0.0001;
  bounds.angle_per_angle = 0.2;
  bounds.angle_per_distance = 0.02;
  bounds.angle_per_time = 0.002;
  bounds.min_angle = 0.0002;
  bounds.lateral_per_distance = 0.5;
  bounds.max_time = 10.0;
  return bounds;
}

TEST(MakeWindow, AddsEachTermOfDAndPhi) {
  const SearchWindow window = MakeWindow({1.0, 0.0, 1.0}, 1.0, DecimalBounds());
  EXPECT_NEAR(window.half_distance, 0.1111, 1e-15);
  EXPECT_NEAR(window.half_angle, 0.2222, 1e-15);
  EXPECT_NEAR(window.half_lateral, 0.05555, 1e-15);
}

TEST(MakeWindow, HasAFloorWithoutMotionAndTime) {
  const SearchWindow window = MakeWindow({}, 0.0, DecimalBounds());
  EXPECT_DOUBLE_EQ(window.half_distance, 0.0001);
  EXPECT_DOUBLE_EQ(window.half_angle, 0.0002);
}

TEST(MakeWindow, MeasuresTheWayInAnyDirectionAndTheTurnInBothSenses) {
  const SearchWindow left = MakeWindow({3.0, 4.0, 0.7}, 0.0, DecimalBounds());
  const SearchWindow right = MakeWindow({-3.0, -4.0, -0.7}, 0.0, DecimalBounds());
  EXPECT_NEAR(left.half_distance, 0.0001 + 0.5 + 0.007, 1e-15);
  EXPECT_NEAR(left.half_angle, 0.0002 + 0.14 + 0.1, 1e-15);
  EXPECT_DOUBLE_EQ(left.half_distance, right.half_distance);
  EXPECT_DOUBLE_EQ(left.half_angle, right.half_angle);
}

TEST(MakeWindow, GrowsWithTimeUpToAMaximum) {
  const SearchWindow five = MakeWindow({}, 5.0, DecimalBounds());
  const SearchWindow ten = MakeWindow({}, 10.0, DecimalBounds());
  const SearchWindow hundred = MakeWindow({}, 100.0, DecimalBounds());
  EXPECT_NEAR(five.half_distance, 0.0001 + 0.005, 1e-15);
  EXPECT_NEAR(ten.half_angle, 0.0002 + 0.02, 1e-15);
  EXPECT_DOUBLE_EQ(hundred.half_distance, ten.half_distance);
  EXPECT_DOUBLE_EQ(hundred.half_angle, ten.half_angle);
}

TEST(MakeWindow, TakesTimeThatGoesBackForNone) {
  EXPECT_DOUBLE_EQ(MakeWindow({}, -5.0, DecimalBounds()).half_distance, 0.0001);
  EXPECT_DOUBLE_EQ(MakeWindow({}, -5.0, DecimalBounds()).half_angle, 0.0002);
}

TEST(MakeWindow, NeverOpensFartherThanAHalfTurn) {
  MotionBounds bounds = DecimalBounds();
  bounds.min_angle = 10.0;
  EXPECT_DOUBLE_EQ(MakeWindow({}, 0.0, bounds).half_angle, M_PI);
}

TEST(MakeWindow, MakesTheWindowOfThePaper) {
  // 0.6 m/s and 8 deg/s at 40 Hz are D = 15 mm and Phi = 0.2 degrees (section 3.2).
  const MotionBounds bounds{0, 0, 0.6, 0, 0, 0, 8.0 * M_PI / 180.0, 0, 0, 0.5};
  const SearchWindow window = MakeWindow({0.01, 0.0, 0.001}, 0.025, bounds);
  EXPECT_NEAR(window.half_distance, 0.015, 1e-15);
  EXPECT_NEAR(window.half_angle, 0.2 * M_PI / 180.0, 1e-15);
  EXPECT_DOUBLE_EQ(window.half_lateral, 0.0);
}

constexpr SearchWindow kWindow{0.4, 0.2, 0.1};

TEST(SearchWindow, ContainsItsBorders) {
  EXPECT_TRUE(kWindow.Contains({0.4, 0.2, 0.1}));
  EXPECT_TRUE(kWindow.Contains({-0.4, -0.2, -0.1}));
  EXPECT_TRUE(kWindow.Contains({}));
}

TEST(SearchWindow, ContainsNothingBeyondAnyBorder) {
  constexpr double kBeyond = 1.0 + 1e-12;
  for (const double side : {-kBeyond, kBeyond}) {
    EXPECT_FALSE(kWindow.Contains({0.4 * side, 0.0, 0.0}));
    EXPECT_FALSE(kWindow.Contains({0.0, 0.2 * side, 0.0}));
    EXPECT_FALSE(kWindow.Contains({0.0, 0.0, 0.1 * side}));
  }
}

TEST(SearchWindow, DoesNotContainWhatIsNoNumber) {
  EXPECT_FALSE(kWindow.Contains({std::nan(""), 0.0, 0.0}));
  EXPECT_FALSE(kWindow.Contains({0.0, std::nan(""), 0.0}));
  EXPECT_FALSE(kWindow.Contains({0.0, 0.0, std::nan("")}));
}

TEST(SearchWindow, ClampsEachCoordinateAlone) {
  const ArcCoordinates clamped = kWindow.Clamp({1.0, -1.0, 0.05});
  EXPECT_DOUBLE_EQ(clamped.distance, 0.4);
  EXPECT_DOUBLE_EQ(clamped.lateral, -0.2);
  EXPECT_DOUBLE_EQ(clamped.angle, 0.05);
  const ArcCoordinates other = kWindow.Clamp({-1.0, 0.1, -3.0});
  EXPECT_DOUBLE_EQ(other.distance, -0.4);
  EXPECT_DOUBLE_EQ(other.lateral, 0.1);
  EXPECT_DOUBLE_EQ(other.angle, -0.1);
  EXPECT_TRUE(kWindow.Contains(clamped));
}

struct NamedBound {
  const char* name;
  double MotionBounds::*field;
};
constexpr NamedBound kFields[] = {
    {"distance_per_distance", &MotionBounds::distance_per_distance},
    {"distance_per_angle", &MotionBounds::distance_per_angle},
    {"distance_per_time", &MotionBounds::distance_per_time},
    {"min_distance", &MotionBounds::min_distance},
    {"angle_per_angle", &MotionBounds::angle_per_angle},
    {"angle_per_distance", &MotionBounds::angle_per_distance},
    {"angle_per_time", &MotionBounds::angle_per_time},
    {"min_angle", &MotionBounds::min_angle},
    {"lateral_per_distance", &MotionBounds::lateral_per_distance},
    {"max_time", &MotionBounds::max_time},
};

/// The message of Validate, or nothing if it does not throw.
std::string Complaint(const MotionBounds& bounds) {
  try {
    bounds.Validate();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(MotionBounds, NamesTheFieldThatIsWrong) {
  for (const NamedBound& named : kFields) {
    for (const double wrong : {-1e-9, std::nan(""), std::numeric_limits<double>::infinity()}) {
      MotionBounds bounds;
      bounds.*named.field = wrong;
      const std::string expected = std::string(named.name) + " must be";
      EXPECT_EQ(Complaint(bounds).substr(0, expected.size()), expected) << wrong;
    }
  }
}

TEST(MotionBounds, AcceptsZeros) {
  MotionBounds bounds;
  for (const NamedBound& named : kFields) bounds.*named.field = 0.0;
  EXPECT_EQ(Complaint(bounds), "");
}

}  // namespace
}  // namespace scan_image_slam
