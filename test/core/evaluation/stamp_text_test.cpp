#include "scan_image_slam/core/evaluation/stamp_text.h"

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

TEST(ParseStamp, IsExactWhereADoubleIsNot) {
  EXPECT_EQ(ParseStamp("1700000000.123456789"), Stamp{1700000000123456789});
  EXPECT_EQ(ParseStamp("1700000000.123456788"), Stamp{1700000000123456788});
}

TEST(ParseStamp, ReadsTheWaysNumbersAreWritten) {
  EXPECT_EQ(ParseStamp("0"), Stamp{0});
  EXPECT_EQ(ParseStamp("-0.0"), Stamp{0});
  EXPECT_EQ(ParseStamp("7"), Stamp{7000000000});
  EXPECT_EQ(ParseStamp("7."), Stamp{7000000000});
  EXPECT_EQ(ParseStamp(".5"), Stamp{500000000});
  EXPECT_EQ(ParseStamp("+0001.25"), Stamp{1250000000});
  EXPECT_EQ(ParseStamp("-1.000000001"), Stamp{-1000000001});
  EXPECT_EQ(ParseStamp("1.403636579763555574e+09"), Stamp{1403636579763555574});
  EXPECT_EQ(ParseStamp("12345E-3"), Stamp{12345000000});
  EXPECT_EQ(ParseStamp("0.000000001e9"), Stamp{1000000000});
}

TEST(ParseStamp, RoundsBelowTheNanosecond) {
  EXPECT_EQ(ParseStamp("0.0000000014"), Stamp{1});
  EXPECT_EQ(ParseStamp("0.0000000015"), Stamp{2});
  EXPECT_EQ(ParseStamp("0.0000000005"), Stamp{1});
  EXPECT_EQ(ParseStamp("0.00000000049"), Stamp{0});
  EXPECT_EQ(ParseStamp("1e-300"), Stamp{0});
  EXPECT_EQ(ParseStamp("0.9999999999"), Stamp{1000000000});
}

TEST(ParseStamp, RefusesWhatIsNotATime) {
  for (const char* text : {"", "-", ".", "e5", "1e", "1e+", "abc", "1.2.3", "1,5", "0x10", "1 ",
                           " 1", "nan", "inf", "1e99999999999", "1e+-5", "--1"}) {
    EXPECT_EQ(ParseStamp(text), std::nullopt) << text;
  }
}

TEST(ParseStamp, RefusesTimesBeyondTheRange) {
  EXPECT_EQ(ParseStamp("9223372036.854775807"), std::numeric_limits<Stamp>::max());
  EXPECT_EQ(ParseStamp("9223372036.854775808"), std::nullopt);
  EXPECT_EQ(ParseStamp("9999999999.999999999"), std::nullopt);
  EXPECT_EQ(ParseStamp("1403636579763555574"), std::nullopt);  // nanoseconds taken for seconds
}

TEST(FormatStamp, HasNineDecimals) {
  EXPECT_EQ(FormatStamp(0), "0.000000000");
  EXPECT_EQ(FormatStamp(1), "0.000000001");
  EXPECT_EQ(FormatStamp(-1), "-0.000000001");
  EXPECT_EQ(FormatStamp(1700000000018422000), "1700000000.018422000");
  EXPECT_EQ(FormatStamp(std::numeric_limits<Stamp>::min()), "-9223372036.854775808");
}

TEST(FormatStamp, ComesBackExactly) {
  for (const Stamp stamp :
       std::vector<Stamp>{0, 1, -1, 999999999, 1000000000, -1500000000, 1700000000123456789,
                          976052857337530000, std::numeric_limits<Stamp>::max()}) {
    EXPECT_EQ(ParseStamp(FormatStamp(stamp)), stamp);
  }
}

}  // namespace
}  // namespace scan_image_slam
