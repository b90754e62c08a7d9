#include "scan_image_slam/core/evaluation/trajectory.h"

#include <cmath>
#include <filesystem>
#include <limits>
#include <locale>
#include <sstream>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

constexpr char kGoodLine[] = "1.5 2 3 0 0 0 0 1\n";

Trajectory Read(const std::string& text) {
  std::istringstream input(text);
  return ReadTum(input, "run.tum");
}

/// What is wrong with `text`, or nothing if it is read.
std::string ErrorOf(const std::string& text) {
  try {
    Read(text);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

std::string Write(const Trajectory& trajectory) {
  std::ostringstream output;
  WriteTum(output, trajectory);
  return output.str();
}

/// 1.234,5 instead of 1234.5
class CommaNumbers : public std::numpunct<char> {
 protected:
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

class CommaLocale {
 public:
  CommaLocale()
      : before_(std::locale::global(std::locale(std::locale::classic(), new CommaNumbers))) {}
  ~CommaLocale() { std::locale::global(before_); }

 private:
  std::locale before_;
};

TEST(ReadTum, ReadsPosesCommentsAndBlanks) {
  const Trajectory trajectory = Read(
      "# timestamp tx ty tz qx qy qz qw\n"
      "\n"
      "1700000000.018422 5.75 -1.6 0.3 0 0 0.7071067811865476 0.7071067811865476\r\n"
      "  \t1.7000000010e+09\t6 1e1 0 0 0 -1 0");
  ASSERT_EQ(trajectory.size(), 2u);
  EXPECT_EQ(trajectory[0].stamp, 1700000000018422000);
  EXPECT_DOUBLE_EQ(trajectory[0].pose.x, 5.75);
  EXPECT_DOUBLE_EQ(trajectory[0].pose.y, -1.6);
  EXPECT_NEAR(trajectory[0].pose.theta, M_PI / 2.0, 1e-12);
  EXPECT_EQ(trajectory[1].stamp, 1700000001000000000);
  EXPECT_DOUBLE_EQ(trajectory[1].pose.y, 10.0);
  EXPECT_NEAR(std::abs(trajectory[1].pose.theta), M_PI, 1e-12);
}

TEST(ReadTum, TakesTheYawOfAQuaternionWithRollAndPitch) {
  // yaw 0.5, then pitch 0.3, then roll -0.2: q = qz(0.5) qy(0.3) qx(-0.2)
  EXPECT_NEAR(Read("0 0 0 0 -0.13243055 0.11964727 0.2578589 0.94955541").front().pose.theta, 0.5,
              1e-6);
}

TEST(ReadTum, AcceptsAFewDecimalsAndScalesThem) {
  EXPECT_NEAR(Read("0 0 0 0 0 0 0.71 0.71").front().pose.theta, M_PI / 2.0, 1e-12);
}

TEST(ReadTum, NamesTheLineWithTheWrongNumberOfColumns) {
  EXPECT_EQ(ErrorOf(std::string("# comment\n") + kGoodLine + "2 0 0 0 0 0 1\n"),
            "run.tum:3: 7 columns instead of 8 (timestamp tx ty tz qx qy qz qw)");
  EXPECT_EQ(ErrorOf("1,0,0,0,0,0,0,1"),
            "run.tum:1: 1 columns instead of 8 (timestamp tx ty tz qx qy qz qw)");
}

TEST(ReadTum, NamesWhatIsNotANumber) {
  EXPECT_EQ(ErrorOf("0 1 abc 0 0 0 0 1"), "run.tum:1: ty 'abc' is not a number");
  EXPECT_EQ(ErrorOf("0 1 2x 0 0 0 0 1"), "run.tum:1: ty '2x' is not a number");
  EXPECT_EQ(ErrorOf("0 1 1,5 0 0 0 0 1"), "run.tum:1: ty '1,5' is not a number");
  EXPECT_EQ(ErrorOf("x 1 2 0 0 0 0 1"), "run.tum:1: timestamp 'x' is not a time in seconds");
  EXPECT_EQ(ErrorOf("1403636579763555584 1 2 0 0 0 0 1"),
            "run.tum:1: timestamp '1403636579763555584' is not a time in seconds");
}

TEST(ReadTum, NamesWhatIsNotFinite) {
  EXPECT_EQ(ErrorOf("nan 1 2 0 0 0 0 1"), "run.tum:1: timestamp 'nan' is not finite");
  EXPECT_EQ(ErrorOf("0 -NaN 2 0 0 0 0 1"), "run.tum:1: tx '-NaN' is not finite");
  EXPECT_EQ(ErrorOf("0 1 2 inf 0 0 0 1"), "run.tum:1: tz 'inf' is not finite");
  EXPECT_EQ(ErrorOf("0 1 2 0 0 0 0 +Infinity"), "run.tum:1: qw '+Infinity' is not finite");
}

TEST(ReadTum, KeepsUnprintableTextOutOfTheMessage) {
  EXPECT_EQ(ErrorOf("0 1 \x1b[2J 0 0 0 0 1"), "run.tum:1: ty '?[2J' is not a number");
}

TEST(ReadTum, RefusesAQuaternionThatIsNone) {
  EXPECT_EQ(ErrorOf("0 0 0 0 0 0 0 0"),
            "run.tum:1: norm of the quaternion is 0.000000 instead of 1");
  EXPECT_EQ(ErrorOf("0 0 0 0 0 0 0.5 1"),
            "run.tum:1: norm of the quaternion is 1.118034 instead of 1");
}

TEST(ReadTum, NamesTheStampThatDoesNotIncrease) {
  const std::string first = "# before\n1.5 0 0 0 0 0 0 1\n# between\n";
  EXPECT_EQ(ErrorOf(first + "1.4 0 0 0 0 0 0 1"),
            "run.tum:4: timestamp 1.400000000 does not increase: line 2 has 1.500000000");
  EXPECT_EQ(ErrorOf(first + "1.5 0 0 0 0 0 0 1"),
            "run.tum:4: timestamp 1.500000000 does not increase: line 2 has 1.500000000");
  EXPECT_EQ(ErrorOf(first + "1.500000001 0 0 0 0 0 0 1"), "");
}

TEST(ReadTum, RefusesAFileWithoutPoses) {
  EXPECT_EQ(ErrorOf("# nothing\n\n"), "run.tum: holds no poses");
}

TEST(ReadTumFile, NamesTheFileThatCannotBeRead) {
  EXPECT_THROW(
      {
        try {
          ReadTumFile("/no/such/file.tum");
        } catch (const std::runtime_error& error) {
          EXPECT_STREQ(error.what(), "cannot open /no/such/file.tum: No such file or directory");
          throw;
        }
      },
      std::runtime_error);
  EXPECT_THROW(ReadTumFile(testing::TempDir()), std::runtime_error);  // a folder
}

TEST(WriteTum, WritesNineDecimals) {
  EXPECT_EQ(Write({{1700000000018422001, {1.25, -3.0, M_PI / 2.0}}}),
            "1700000000.018422001 1.250000000 -3.000000000 0.000000000 0.000000000 0.000000000 "
            "0.707106781 0.707106781\n");
}

TEST(WriteTum, ComesBack) {
  const Trajectory written{{-5, {0.0, 0.0, 0.0}},
                           {976052857337530001, {1234.567891234, -0.000000004, 3.1}},
                           {976052857337530002, {-1e-3, 5e4, -3.1}},
                           {976052857337530003, {0.1, 0.2, 10.0}}};
  const Trajectory read = Read(Write(written));
  ASSERT_EQ(read.size(), written.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].stamp, written[i].stamp);
    EXPECT_NEAR(read[i].pose.x, written[i].pose.x, 5.1e-10);
    EXPECT_NEAR(read[i].pose.y, written[i].pose.y, 5.1e-10);
    EXPECT_NEAR(NormalizeAngle(read[i].pose.theta - written[i].pose.theta), 0.0, 2e-9);
  }
  EXPECT_EQ(Write(read), Write(written));
}

TEST(WriteTum, IsTheSameInEveryLocale) {
  const Trajectory trajectory{{1700000000018422001, {1234.5, -3.25, 1.0}}};
  const std::string expected = Write(trajectory);
  const CommaLocale comma_locale;
  EXPECT_EQ(Write(trajectory), expected);
  EXPECT_DOUBLE_EQ(Read(expected).front().pose.x, 1234.5);
}

TEST(WriteTum, RefusesAPoseThatIsNotFinite) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(Write({{0, {kNan, 0.0, 0.0}}}), std::invalid_argument);
  EXPECT_THROW(Write({{0, {0.0, 0.0, kNan}}}), std::invalid_argument);
}

TEST(WriteTumFile, ComesBackFromTheFile) {
  const std::string path = testing::TempDir() + "trajectory_test.tum";
  WriteTumFile(path, {{1, {1.0, 2.0, 0.5}}, {2, {1.0, 2.0, 0.5}}});
  EXPECT_EQ(ReadTumFile(path).size(), 2u);
  std::filesystem::remove(path);
}

TEST(WriteTumFile, ReportsFilesThatCannotBeWritten) {
  EXPECT_THROW(WriteTumFile("/no/such/folder/a.tum", {}), std::runtime_error);
  EXPECT_THROW(WriteTumFile("/dev/full", {{1, {1.0, 2.0, 0.5}}}), std::runtime_error);
}

}  // namespace
}  // namespace scan_image_slam
