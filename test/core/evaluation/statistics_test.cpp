#include "scan_image_slam/core/evaluation/statistics.h"

#include <cmath>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

TEST(Summarize, ComputesByHand) {
  const Statistics statistics = Summarize({4.0, 1.0, 3.0, 2.0});
  EXPECT_EQ(statistics.count, 4u);
  EXPECT_DOUBLE_EQ(statistics.mean, 2.5);
  EXPECT_DOUBLE_EQ(statistics.standard_deviation, std::sqrt(1.25));
  EXPECT_DOUBLE_EQ(statistics.median, 2.5);
  EXPECT_DOUBLE_EQ(statistics.rms, std::sqrt(7.5));
  EXPECT_DOUBLE_EQ(statistics.max, 4.0);
}

TEST(Summarize, MedianOfAnOddNumberIsTheMiddle) {
  EXPECT_DOUBLE_EQ(Summarize({9.0, 1.0, 2.0}).median, 2.0);
  EXPECT_DOUBLE_EQ(Summarize({5.0}).median, 5.0);
}

TEST(Summarize, HasNoErrorsWithoutValues) {
  const Statistics statistics = Summarize({});
  EXPECT_EQ(statistics.count, 0u);
  EXPECT_TRUE(std::isnan(statistics.mean));
  EXPECT_TRUE(std::isnan(statistics.median));
  EXPECT_TRUE(std::isnan(statistics.rms));
  EXPECT_TRUE(std::isnan(statistics.max));
}

TEST(Percentile, IsTheSmallestValueThatCoversTheShare) {
  const std::vector<double> values = {30.0, 10.0, 40.0, 20.0};
  EXPECT_EQ(Percentile(values, 1.0), 10.0);
  EXPECT_EQ(Percentile(values, 25.0), 10.0);
  EXPECT_EQ(Percentile(values, 25.1), 20.0);
  EXPECT_EQ(Percentile(values, 50.0), 20.0);
  EXPECT_EQ(Percentile(values, 99.0), 40.0);
  EXPECT_EQ(Percentile(values, 100.0), 40.0);
  EXPECT_TRUE(std::isnan(Percentile({}, 50.0)));
}

}  // namespace
}  // namespace scan_image_slam
