#include "scan_image_slam/core/sensor/stamp.h"

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

TEST(Stamp, CountsNanoseconds) {
  EXPECT_EQ(FromSeconds(1.5), 1500000000);
  EXPECT_EQ(FromSeconds(-0.025), -25000000);
  EXPECT_DOUBLE_EQ(Seconds(25000000), 0.025);
  EXPECT_DOUBLE_EQ(Seconds(-1500000000), -1.5);
}

TEST(Stamp, RoundsToTheNearestNanosecond) {
  EXPECT_EQ(FromSeconds(1.6e-9), 2);
  EXPECT_EQ(FromSeconds(1.4e-9), 1);
  EXPECT_EQ(FromSeconds(-1.6e-9), -2);
  EXPECT_EQ(FromSeconds(-1.4e-9), -1);
}

}  // namespace
}  // namespace scan_image_slam
