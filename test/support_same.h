#pragma once

#include "scan_image_slam/core/geometry/pose2.h"

#include <gtest/gtest.h>

namespace scan_image_slam {

/// Of poses or velocities: every number the same, to the last bit.
template <typename T>
void ExpectSameNumbers(const T& a, const T& b) {
  EXPECT_EQ(a.x, b.x);
  EXPECT_EQ(a.y, b.y);
  EXPECT_EQ(a.theta, b.theta);
}

inline void ExpectSame(const Pose2& a, const Pose2& b) { ExpectSameNumbers(a, b); }
inline void ExpectSame(const Velocity2& a, const Velocity2& b) { ExpectSameNumbers(a, b); }

}  // namespace scan_image_slam
