#include "scan_image_slam/core/evaluation/key_values.h"

#include <cstddef>
#include <limits>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

TEST(KeyValues, MakesOneLine) {
  KeyValues line;
  line.Add("poses", std::size_t{12000}).Add("error_m", 0.00361449).Add("way_m", 12345.5);
  EXPECT_EQ(line.Line(), "poses=12000 error_m=0.003614 way_m=12345.500000");
}

TEST(KeyValues, WritesNanForWhatDoesNotExist) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(KeyValues().Add("a", kNan).Add("b", -kNan).Line(), "a=nan b=nan");
}

}  // namespace
}  // namespace scan_image_slam
