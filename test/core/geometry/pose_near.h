#pragma once

#include "scan_image_slam/core/geometry/pose2.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace scan_image_slam {

/// Shortest turn from one angle to another, without the code under test [rad].
inline double AngleBetween(double a, double b) {
  return std::atan2(std::sin(b - a), std::cos(b - a));
}

inline void ExpectPoseNear(const Pose2& actual, const Pose2& expected, double tolerance = 1e-9) {
  EXPECT_NEAR(actual.x, expected.x, tolerance);
  EXPECT_NEAR(actual.y, expected.y, tolerance);
  EXPECT_NEAR(AngleBetween(expected.theta, actual.theta), 0.0, tolerance);
}

/// Repeatable numbers for properties.
class Dice {
 public:
  double Between(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_()) / 4294967295.0;
  }
  Pose2 Pose() { return {Between(-5.0, 5.0), Between(-5.0, 5.0), Between(-M_PI, M_PI)}; }

 private:
  std::mt19937 engine_{20240607};
};

/// Where a body ends that keeps its velocity, by many small steps: an oracle for arcs.
inline Pose2 DriveInSmallSteps(const Velocity2& velocity, double dt) {
  constexpr int kSteps = 20000;
  const double step = dt / kSteps;
  Pose2 pose;
  for (int i = 0; i < kSteps; ++i) {
    const double heading = pose.theta + 0.5 * velocity.theta * step;
    pose.x += step * (velocity.x * std::cos(heading) - velocity.y * std::sin(heading));
    pose.y += step * (velocity.x * std::sin(heading) + velocity.y * std::cos(heading));
    pose.theta += velocity.theta * step;
  }
  return pose;
}

}  // namespace scan_image_slam
