#include "scan_image_slam/core/config/parameter_set.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

enum class Colour { kRed, kGreen };

/// One parameter of each kind.
class ParameterSetTest : public ::testing::Test {
 protected:
  ParameterSetTest() : set_("painter") {
    set_.Add("dry", &dry_, "a switch");
    set_.Add("coats", &coats_, "-", {1.0, 5.0}, "a count");
    set_.Add("brush/width", &width_, "m", {0.5, 2.0}, "a length");
    set_.Add("frame", &frame_, "a name");
    set_.AddDegrees("brush/tilt_deg", &tilt_, {-90.0, 90.0}, "an angle");
    set_.AddChoice("colour", &colour_, {{"red", Colour::kRed}, {"green", Colour::kGreen}},
                   "one of two");
  }

  std::string ErrorOf(const std::string& name, const ParameterValue& value) {
    try {
      set_.Set(name, value);
    } catch (const ParameterError& error) {
      return error.what();
    }
    return "no error";
  }

  ParameterSet set_;
  bool dry_ = false;
  int coats_ = 2;
  double width_ = 1.0;
  std::string frame_ = "base";
  double tilt_ = 0.0;
  Colour colour_ = Colour::kRed;
};

TEST_F(ParameterSetTest, SetsTheFieldThatItPointsTo) {
  set_.Set("dry", true);
  set_.Set("coats", 3);
  set_.Set("brush/width", 1.5);
  set_.Set("frame", std::string("lid"));
  set_.Set("brush/tilt_deg", 45.0);
  set_.Set("colour", std::string("green"));
  EXPECT_TRUE(dry_);
  EXPECT_EQ(coats_, 3);
  EXPECT_EQ(width_, 1.5);
  EXPECT_EQ(frame_, "lid");
  EXPECT_DOUBLE_EQ(tilt_, M_PI / 4.0);
  EXPECT_EQ(colour_, Colour::kGreen);
}

TEST_F(ParameterSetTest, TellsWhatTheFieldHolds) {
  dry_ = true;
  coats_ = 4;
  width_ = 0.75;
  frame_ = "lid";
  tilt_ = -M_PI / 6.0;
  colour_ = Colour::kGreen;
  const ParameterValue expected[] = {
      true, 4, 0.75, std::string("lid"), -30.0, std::string("green")};
  ASSERT_EQ(set_.parameters().size(), 6U);
  for (int i = 0; i < 6; ++i) EXPECT_EQ(set_.parameters()[i].get(), expected[i]) << i;
}

TEST_F(ParameterSetTest, KnowsWhatDiffers) {
  double width = 1.0;
  double tilt = M_PI / 6.0 + 1e-14;  // the same when it is written
  std::string frame = "lid";
  ParameterSet other("painter");
  other.Add("brush/width", &width, "m", {0.5, 2.0}, "a length");
  other.AddDegrees("brush/tilt_deg", &tilt, {-90.0, 90.0}, "an angle");
  other.Add("frame", &frame, "a name");
  tilt_ = M_PI / 6.0;
  const ParameterSet different = other.DifferentFrom(set_);
  ASSERT_EQ(different.parameters().size(), 1U);
  EXPECT_EQ(different.node(), "painter");
  EXPECT_EQ(different.parameters()[0].name, "frame");
  EXPECT_EQ(different.parameters()[0].get(), ParameterValue(std::string("lid")));
}

TEST_F(ParameterSetTest, WholeNumbersAreNumbers) {
  set_.Set("brush/width", 2);
  EXPECT_EQ(width_, 2.0);
  set_.Set("brush/tilt_deg", -90);
  EXPECT_DOUBLE_EQ(tilt_, -M_PI / 2.0);
}

TEST_F(ParameterSetTest, NumbersThatYamlTakesForTextAreNumbers) {
  set_.Set("brush/width", std::string("75e-2"));
  EXPECT_EQ(width_, 0.75);
  EXPECT_NE(ErrorOf("brush/width", std::string("1 m")), "no error");
  EXPECT_NE(ErrorOf("brush/width", std::string("")), "no error");
  EXPECT_NE(ErrorOf("coats", std::string("2")), "no error");  // quoted on purpose
}

TEST_F(ParameterSetTest, BordersAreInRange) {
  for (const double width : {0.5, 2.0}) {
    set_.Set("brush/width", width);
    EXPECT_EQ(width_, width);
  }
  for (const int coats : {1, 5}) {
    set_.Set("coats", coats);
    EXPECT_EQ(coats_, coats);
  }
}

TEST_F(ParameterSetTest, OutOfRangeNamesTheParameterTheValueAndTheRange) {
  EXPECT_EQ(ErrorOf("brush/width", 2.001),
            "painter/brush/width: 2.001 is out of range, allowed are 0.5 to 2.0");
  EXPECT_EQ(ErrorOf("brush/width", 0),
            "painter/brush/width: 0.0 is out of range, allowed are 0.5 "
            "to 2.0");
  EXPECT_EQ(ErrorOf("coats", 6), "painter/coats: 6.0 is out of range, allowed are 1.0 to 5.0");
  EXPECT_EQ(ErrorOf("brush/tilt_deg", 91.0),
            "painter/brush/tilt_deg: 91.0 is out of range, allowed are -90.0 to 90.0");
  EXPECT_EQ(width_, 1.0);
  EXPECT_EQ(coats_, 2);
}

TEST_F(ParameterSetTest, NoRangeHoldsWhatIsNotFinite) {
  double free = 1.0;
  set_.Add("free", &free, "-", {}, "any number");
  for (const double value : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    EXPECT_NE(ErrorOf("free", value).find("painter/free: "), std::string::npos) << value;
  }
  EXPECT_EQ(free, 1.0);
}

TEST_F(ParameterSetTest, AWrongTypeIsToldWithTheRightOne) {
  EXPECT_EQ(ErrorOf("dry", 1), "painter/dry: 1 is of type int, expected is bool");
  EXPECT_EQ(ErrorOf("coats", 2.0), "painter/coats: 2.0 is of type double, expected is int");
  EXPECT_EQ(ErrorOf("coats", true), "painter/coats: true is of type bool, expected is int");
  EXPECT_EQ(ErrorOf("brush/width", true),
            "painter/brush/width: true is of type bool, expected is double");
  EXPECT_EQ(ErrorOf("brush/width", std::string("wide")),
            "painter/brush/width: \"wide\" is of type string, expected is double");
  EXPECT_EQ(ErrorOf("frame", 7), "painter/frame: 7 is of type int, expected is string");
  EXPECT_EQ(ErrorOf("colour", false), "painter/colour: false is of type bool, expected is string");
}

TEST_F(ParameterSetTest, AChoiceThatIsNoneIsToldWithAllOfThem) {
  EXPECT_EQ(ErrorOf("colour", std::string("blue")),
            "painter/colour: \"blue\" is not one of red, green");
  EXPECT_EQ(colour_, Colour::kRed);
}

TEST_F(ParameterSetTest, AnUnknownNameIsToldWithTheMostSimilarOne) {
  EXPECT_EQ(ErrorOf("brush/widht", 1.0),
            "painter/brush/widht: unknown parameter, did you mean brush/width?");
  EXPECT_EQ(ErrorOf("color", std::string("red")),
            "painter/color: unknown parameter, did you mean colour?");
}

TEST_F(ParameterSetTest, ANameOfAnotherPackageIsExplained) {
  EXPECT_EQ(ErrorOf("delta", 0.1),
            "painter/delta: a parameter of gmapping, not used; use mapper/resolution");
}

TEST_F(ParameterSetTest, WithoutParametersNothingIsSuggested) {
  set_ = ParameterSet("idle");
  EXPECT_EQ(ErrorOf("x", 1), "idle/x: unknown parameter");
}

TEST_F(ParameterSetTest, AValueIsCheckedWithoutBeingSet) {
  EXPECT_EQ(set_.Checked("brush/width", 2), ParameterValue(2.0));
  EXPECT_THROW(set_.Checked("brush/width", 2.5), ParameterError);
  EXPECT_EQ(width_, 1.0);
}

TEST_F(ParameterSetTest, KnowsItsNames) {
  EXPECT_TRUE(set_.Has("brush/width"));
  EXPECT_FALSE(set_.Has("brush"));
  EXPECT_EQ(set_.Get("coats").description, "a count");
  EXPECT_THROW(set_.Get("coat"), ParameterError);
}

TEST_F(ParameterSetTest, NothingIsLiveUnlessItIsAllowed) {
  const auto live = [this] {
    std::vector<std::string> names;
    for (const Parameter& p : set_.parameters()) {
      if (p.live) names.push_back(p.name);
    }
    return names;
  };
  EXPECT_EQ(live(), std::vector<std::string>());
  set_.AllowLive({"brush/", "coats"});
  EXPECT_EQ(live(), (std::vector<std::string>{"coats", "brush/width", "brush/tilt_deg"}));
  EXPECT_THROW(set_.AllowLive({"brush"}), ParameterError);
  EXPECT_THROW(set_.AllowLive({"roller/"}), ParameterError);
}

TEST_F(ParameterSetTest, TellsRangesInWords) {
  set_.Add("price", &width_, "-", {1e-9, 1e9}, "a number");
  set_.Add("debts", &width_, "-", {0.0, 1e9}, "a number");
  set_.Add("place", &width_, "m", {-1e9, 1e9}, "a number");
  const auto range = [this](const std::string& name) { return RangeText(set_.Get(name)); };
  EXPECT_EQ(range("dry"), "");
  EXPECT_EQ(range("frame"), "");
  EXPECT_EQ(range("colour"), "red, green");
  EXPECT_EQ(range("brush/width"), "0.5 to 2.0");
  EXPECT_EQ(range("price"), "positive");
  EXPECT_EQ(range("debts"), "not negative");
  EXPECT_EQ(range("place"), "");
}

TEST_F(ParameterSetTest, SetsSeveralByName) {
  set_.Set({{"coats", 5}, {"brush/width", 0.5}});
  EXPECT_EQ(coats_, 5);
  EXPECT_EQ(width_, 0.5);
  EXPECT_THROW(set_.Set({{"coats", 1}, {"cotas", 1}}), ParameterError);
}

TEST(ParameterText, IsYaml) {
  EXPECT_EQ(ToText(true), "true");
  EXPECT_EQ(ToText(false), "false");
  EXPECT_EQ(ToText(-3), "-3");
  EXPECT_EQ(ToText(std::string("base")), "\"base\"");
}

TEST(ParameterText, NumbersHaveAPointSoThatRosparamTakesThemForNumbers) {
  EXPECT_EQ(ToText(2.0), "2.0");
  EXPECT_EQ(ToText(-0.25), "-0.25");
  EXPECT_EQ(ToText(1e-5), "1.0e-05");
  EXPECT_EQ(ToText(1e9), "1000000000.0");
  EXPECT_EQ(ToText(2.5e20), "2.5e+20");
  EXPECT_EQ(ToText(0.1 + 0.2), "0.3");
}

}  // namespace
}  // namespace scan_image_slam
