#include "scan_image_slam/core/simulation/random_stream.h"

#include <cmath>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

TEST(RandomStream, FirstNumbersNeverChange) {
  // Another value here means that all recorded simulations change.
  RandomStream stream(1, "laser noise");
  EXPECT_DOUBLE_EQ(stream.Uniform(), RandomStream(1, "laser noise").Uniform());
  RandomStream fixed(42, "test");
  EXPECT_NEAR(fixed.Uniform(), 0.13160687161535989, 1e-15);
}

TEST(RandomStream, SeedsAndNamesDiffer) {
  const double a = RandomStream(1, "a").Uniform();
  EXPECT_NE(a, RandomStream(2, "a").Uniform());
  EXPECT_NE(a, RandomStream(1, "b").Uniform());
}

TEST(RandomStream, UniformFillsItsRange) {
  RandomStream stream(3, "test");
  double low = 1.0;
  double high = 0.0;
  double sum = 0.0;
  constexpr int kCount = 100000;
  for (int i = 0; i < kCount; ++i) {
    const double value = stream.Uniform(0.0, 1.0);
    low = std::min(low, value);
    high = std::max(high, value);
    sum += value;
  }
  EXPECT_GE(low, 0.0);
  EXPECT_LT(high, 1.0);
  EXPECT_LT(low, 1e-3);
  EXPECT_GT(high, 1.0 - 1e-3);
  EXPECT_NEAR(sum / kCount, 0.5, 0.005);
}

TEST(RandomStream, NormalHasMeanSpreadAndTails) {
  RandomStream stream(4, "test");
  double sum = 0.0;
  double squares = 0.0;
  int beyond_two = 0;
  constexpr int kCount = 200000;
  for (int i = 0; i < kCount; ++i) {
    const double value = stream.Normal();
    sum += value;
    squares += value * value;
    beyond_two += std::abs(value) > 2.0 ? 1 : 0;
  }
  EXPECT_NEAR(sum / kCount, 0.0, 0.01);
  EXPECT_NEAR(squares / kCount, 1.0, 0.015);
  EXPECT_NEAR(static_cast<double>(beyond_two) / kCount, 0.0455, 0.002);
}

TEST(RandomStream, IndexStaysBelowCount) {
  RandomStream stream(5, "test");
  for (int i = 0; i < 10000; ++i) EXPECT_LT(stream.Index(7), 7U);
}

}  // namespace
}  // namespace scan_image_slam
