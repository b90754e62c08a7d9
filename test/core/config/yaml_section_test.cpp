#include "scan_image_slam/core/config/yaml_section.h"

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

YamlSection Parse(const std::string& text) { return YamlSection::FromText(text, "test.yaml"); }

/// The message of the YamlError that `action` throws.
template <typename Action>
std::string ErrorOf(const Action& action) {
  try {
    action();
  } catch (const YamlError& error) {
    return error.what();
  }
  return "no error";
}

TEST(YamlSection, ReadsWhatIsThere) {
  YamlSection section = Parse("a: 1.5\nb: 3\nc: true\nd: text\ne: [1, 2]\nf: [4]\ng: 5");
  EXPECT_DOUBLE_EQ(section.Number("a", 0, 2), 1.5);
  EXPECT_EQ(section.Integer("b", 0, 9), 3);
  EXPECT_TRUE(section.Flag("c", false));
  EXPECT_EQ(section.Text("d"), "text");
  EXPECT_EQ(section.Point("e"), Eigen::Vector2d(1, 2));
  EXPECT_EQ(section.NumberOrNumbers("f", 0, 9), std::vector<double>{4});
  EXPECT_EQ(section.NumberOrNumbers("g", 0, 9), std::vector<double>{5});
  EXPECT_NO_THROW(section.Done());
}

TEST(YamlSection, FallsBackOnlyWhereTheKeyIsAbsent) {
  YamlSection section = Parse("a: 1.5");
  EXPECT_DOUBLE_EQ(section.Number("b", 0, 2, 0.7), 0.7);
  EXPECT_DOUBLE_EQ(section.Number("a", 0, 2, 0.7), 1.5);
}

TEST(YamlSection, NamesFileLineAndKeyOfAnUnknownKey) {
  YamlSection section = Parse("a: 1\n\nlamp: 2\n");
  section.Number("a", 0, 2);
  EXPECT_EQ(ErrorOf([&] { section.Done(); }), "test.yaml:3: key 'lamp': is not known");
}

TEST(YamlSection, NamesThePathOfANestedKey) {
  YamlSection root = Parse("walls:\n  - {from: 1}\n  - {from: 2,\n     to: x}\n");
  std::vector<YamlSection> walls = root.Children("walls");
  EXPECT_EQ(ErrorOf([&] { walls[1].Number("to", 0, 1); }),
            "test.yaml:4: key 'walls[1].to': must be a number");
}

TEST(YamlSection, RefusesWrongValues) {
  YamlSection section = Parse("n: 5\nt: no number\ni: 1.5\nl: [1, 2, 3]\nf: .nan\nm: {a: 1}");
  EXPECT_EQ(ErrorOf([&] { section.Number("n", 0, 4); }),
            "test.yaml:1: key 'n': is 5, must be in [0, 4]");
  EXPECT_EQ(ErrorOf([&] { section.Number("t", 0, 4); }), "test.yaml:2: key 't': must be a number");
  EXPECT_EQ(ErrorOf([&] { section.Integer("i", 0, 4); }),
            "test.yaml:3: key 'i': must be a whole number");
  EXPECT_EQ(ErrorOf([&] { section.Point("l"); }),
            "test.yaml:4: key 'l': must be a list of 2 numbers");
  EXPECT_EQ(ErrorOf([&] { section.Number("f", 0, 4); }), "test.yaml:5: key 'f': must be a number");
  EXPECT_EQ(ErrorOf([&] { section.Text("m"); }), "test.yaml:6: key 'm': must be a text");
  EXPECT_EQ(ErrorOf([&] { section.Flag("n", true); }),
            "test.yaml:1: key 'n': must be true or false");
}

TEST(YamlSection, RefusesMissingAndDoubleKeys) {
  YamlSection section = Parse("a: 1");
  EXPECT_EQ(ErrorOf([&] { section.Number("b", 0, 1); }), "test.yaml:1: key 'b': is missing");
  EXPECT_EQ(ErrorOf([] { Parse("a: 1\nb: 2\na: 3"); }), "test.yaml:3: key 'a': is given twice");
}

TEST(YamlSection, RefusesAnUnknownChoice) {
  YamlSection section = Parse("colour: green");
  EXPECT_EQ(ErrorOf([&] {
              section.Choice("colour", {"red", "blue"}, 0);
            }),
            "test.yaml:1: key 'colour': is 'green', must be one of: red, blue");
}

TEST(YamlSection, RefusesWhatIsNoYamlMap) {
  EXPECT_EQ(ErrorOf([] { Parse("a: [1, 2\nb: 3"); }).substr(0, 10), "test.yaml:");
  EXPECT_EQ(ErrorOf([] { Parse("- 1\n- 2"); }), "test.yaml:1: must be a map of keys and values");
  EXPECT_EQ(ErrorOf([] { YamlSection::FromFile("/nowhere.yaml"); }),
            "/nowhere.yaml: cannot be opened");
}

}  // namespace
}  // namespace scan_image_slam
