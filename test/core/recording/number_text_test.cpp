#include "scan_image_slam/core/recording/number_text.h"

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

TEST(NumberText, HasNoZerosAtTheEnd) {
  EXPECT_EQ(NumberText(0.25, 3), "0.25");
  EXPECT_EQ(NumberText(30.0, 1), "30");
  EXPECT_EQ(NumberText(100.0, 0), "100");
  EXPECT_EQ(NumberText(-0.04, 1), "0");
  EXPECT_EQ(NumberText(-1.26, 1), "-1.3");
}

TEST(DurationText, HasAFittingUnit) {
  EXPECT_EQ(DurationText(0.0), "0 ms");
  EXPECT_EQ(DurationText(0.0043), "4.3 ms");
  EXPECT_EQ(DurationText(0.3), "300 ms");
  EXPECT_EQ(DurationText(-0.9), "-900 ms");
  EXPECT_EQ(DurationText(3.204), "3.2 s");
  EXPECT_EQ(DurationText(40.02), "40 s");
  EXPECT_EQ(DurationText(1800.0), "30 min");
  EXPECT_EQ(DurationText(86400.0 * 400), "400 days");
}

TEST(ShareText, DoesNotHideWhatIsThere) {
  EXPECT_EQ(ShareText(0.0), "0 %");
  EXPECT_EQ(ShareText(0.001), "less than 1 %");
  EXPECT_EQ(ShareText(0.45), "45 %");
  EXPECT_EQ(ShareText(0.999), "more than 99 %");
  EXPECT_EQ(ShareText(1.0), "100 %");
}

TEST(CountText, Plural) {
  EXPECT_EQ(CountText(1, "scan"), "1 scan");
  EXPECT_EQ(CountText(2, "scan"), "2 scans");
  EXPECT_EQ(CountText(0, "scan"), "0 scans");
}

}  // namespace
}  // namespace scan_image_slam
