#include "scan_image_slam/core/config/config_file.h"

#include "scan_image_slam/core/config/slam_parameters.h"
#include "support_folder.h"

#include <sstream>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

const std::string kShipped = SCAN_IMAGE_SLAM_SOURCE_DIR "/config/";

std::string Read(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

TEST(ShippedConfig, DefaultIsWhatTheCodeSays) {
  SlamOptions options;
  EXPECT_EQ(Read(kShipped + "default.yaml"), WriteConfig(options.Parameters()));
}

/// All values, as yaml.
std::vector<std::string> ValuesOf(SlamOptions* options) {
  std::vector<std::string> values;
  for (const ParameterSet& set : options->Parameters()) {
    for (const Parameter& p : set.parameters()) {
      values.push_back(set.node() + "/" + p.name + ": " + ToText(p.get()));
    }
  }
  return values;
}

void Load(const std::string& path, SlamOptions* options) {
  std::vector<ParameterSet> sets = options->Parameters();
  ApplyConfig(ReadConfigFile(path), path, &sets);
}

TEST(ShippedConfig, DefaultChangesNothing) {
  SlamOptions options;
  SlamOptions loaded;
  Load(kShipped + "default.yaml", &loaded);
  EXPECT_EQ(ValuesOf(&loaded), ValuesOf(&options));
}

TEST(ShippedConfig, PaperIsThePapers) {
  SlamOptions options;
  Load(kShipped + "paper.yaml", &options);
  EXPECT_EQ(options.bounded_icp.reference, Reference::kPreviousFrame);
  EXPECT_DOUBLE_EQ(options.fusion.scan.field_of_view, 100.0 * M_PI / 180.0);
  EXPECT_DOUBLE_EQ(options.fusion.scan.min_beam_spacing, 0.25 * M_PI / 180.0);
  EXPECT_DOUBLE_EQ(options.bounded_icp.frame_matcher.frontal_field_of_view, 50.0 * M_PI / 180.0);
  // 15 mm and 0.2 degrees per frame of 25 ms, whatever was driven.
  const SearchWindow window =
      MakeWindow({0.3, 0.0, 0.2}, 0.025, options.bounded_icp.prediction.bounds);
  EXPECT_NEAR(window.half_distance, 0.015, 1e-9);
  EXPECT_NEAR(window.half_angle, 0.2 * M_PI / 180.0, 1e-9);
  EXPECT_EQ(window.half_lateral, 0.0);
}

/// Configuration files of the tests' own.
class ConfigFile : public ::testing::Test {
 protected:
  void Write(const std::string& text) const { folder_.Write("my.yaml", text); }

  /// What loading this text says, without the folder's name.
  std::string ErrorOf(const std::string& text) {
    Write(text);
    try {
      Load(path_, &options_);
    } catch (const ParameterError& error) {
      return folder_.WithoutPath(error.what());
    }
    return "no error";
  }

  const TemporaryFolder folder_;
  const std::string path_ = folder_.File("my.yaml");
  SlamOptions options_;
};

TEST_F(ConfigFile, SectionsSetTheParametersOfTheirNode) {
  Write(
      "scan_image_fusion:\n  max_range: 12.5\n  laser:\n    x: 0.25\n    yaw_deg: 90\n"
      "bounded_icp:\n  reference: previous_frame\nmapper:\n  map_frame: plan\n");
  Load(path_, &options_);
  EXPECT_EQ(options_.fusion.scan.max_range, 12.5);
  EXPECT_EQ(options_.fusion_node.laser.x, 0.25);
  EXPECT_DOUBLE_EQ(options_.fusion_node.laser.yaw, M_PI_2);
  EXPECT_EQ(options_.bounded_icp.reference, Reference::kPreviousFrame);
  EXPECT_EQ(options_.mapper_node.map_frame, "plan");
}

TEST_F(ConfigFile, NamesMayBeWrittenWithSlashes) {
  Write("scan_image_fusion:\n  laser/x: 0.25\n");
  Load(path_, &options_);
  EXPECT_EQ(options_.fusion_node.laser.x, 0.25);
}

TEST_F(ConfigFile, EmptyFilesAndSectionsSetNothing) {
  SlamOptions defaults;
  for (const char* text : {"", "# nothing\n", "mapper:\n", "mapper: {}\n"}) {
    EXPECT_EQ(ErrorOf(text), "no error") << text;
    EXPECT_EQ(ValuesOf(&options_), ValuesOf(&defaults));
  }
}

TEST_F(ConfigFile, AQuotedValueIsText) {
  Write("mapper:\n  map_frame: \"7\"\n");
  Load(path_, &options_);
  EXPECT_EQ(options_.mapper_node.map_frame, "7");
  EXPECT_EQ(ErrorOf("mapper:\n  map_frame: 7\n"),
            "my.yaml: mapper/map_frame: 7 is of type int, expected is string");
}

TEST_F(ConfigFile, BrokenYamlNamesFileAndLine) {
  EXPECT_EQ(ErrorOf("mapper:\n  map_frame: [a\n").find("my.yaml:"), 0U);
  EXPECT_EQ(ErrorOf("mapper:\n  resolution: 0.05\n map_frame: a\n").find("my.yaml:3: "), 0U);
}

TEST_F(ConfigFile, AnUnknownKeyIsNamedWithTheFile) {
  EXPECT_EQ(ErrorOf("mapper:\n  resolutoin: 0.1\n"),
            "my.yaml: mapper/resolutoin: unknown parameter, did you mean resolution?");
  EXPECT_EQ(ErrorOf("scan_image_fusion:\n  lasr:\n    x: 0.1\n"),
            "my.yaml: scan_image_fusion/lasr/x: unknown parameter, did you mean laser/x?");
}

TEST_F(ConfigFile, AnUnknownNodeIsNamedWithTheFile) {
  EXPECT_EQ(ErrorOf("maper:\n  resolution: 0.1\n"), "my.yaml: there is no node maper");
}

TEST_F(ConfigFile, AValueOutOfRangeIsNamedWithFileAndKey) {
  EXPECT_EQ(ErrorOf("mapper:\n  resolution: 0\n"),
            "my.yaml: mapper/resolution: 0.0 is out of range, allowed are 0.001 to 10.0");
}

TEST_F(ConfigFile, WhatIsNoSingleValueIsNamedWithItsLine) {
  EXPECT_EQ(ErrorOf("mapper:\n  resolution: [1, 2]\n"),
            "my.yaml:2: resolution: a single value is expected");
  EXPECT_EQ(ErrorOf("mapper:\n  map_frame: a\n  resolution:\n"),
            "my.yaml:3: resolution: a single value is expected");
}

TEST_F(ConfigFile, WhatIsNoSectionIsNamed) {
  EXPECT_EQ(ErrorOf("\nmapper: 5\n"), "my.yaml:2: mapper: a section is expected");
  EXPECT_EQ(ErrorOf("- 1\n"), "my.yaml: sections named after the nodes are expected");
  EXPECT_EQ(ErrorOf("resolution\n"), "my.yaml: sections named after the nodes are expected");
}

TEST_F(ConfigFile, AKeyThatIsNoNameIsAnError) {
  EXPECT_EQ(ErrorOf("mapper:\n  [1, 2]: 3\n"), "my.yaml:2: a name is expected");
  EXPECT_EQ(ErrorOf("[1, 2]:\n  x: 3\n"), "my.yaml:1: a name is expected");
}

TEST_F(ConfigFile, ANameThatComesTwiceIsAnError) {
  EXPECT_EQ(ErrorOf("mapper:\n  resolution: 0.1\n  resolution: 0.2\n"),
            "my.yaml:3: resolution: is there twice");
  EXPECT_EQ(ErrorOf("mapper:\n  resolution: 0.1\nmapper:\n  tf_delay: 0.2\n"),
            "my.yaml:3: mapper: is there twice");
}

TEST_F(ConfigFile, AMissingFileIsNamed) {
  try {
    ReadConfigFile(path_);
    FAIL();
  } catch (const ParameterError& error) {
    EXPECT_EQ(error.what(), "can't read the configuration " + path_);
  }
}

TEST_F(ConfigFile, AFolderIsNoFile) {
  EXPECT_THROW(ReadConfigFile(folder_.path()), ParameterError);
}

TEST_F(ConfigFile, WhatIsWrittenIsRead) {
  // Every number somewhere in the lower half of its range, with many digits.
  SlamOptions written;
  for (ParameterSet& set : written.Parameters()) {
    for (const Parameter& p : set.parameters()) {
      if (p.type == "bool") set.Set(p.name, !std::get<bool>(p.get()));
      if (p.type == "string") set.Set(p.name, p.choices.empty() ? "a b" : p.choices.back());
      if (p.type == "int") set.Set(p.name, std::get<int>(p.get()) + 1);
      if (p.type == "double") {
        const double value = std::get<double>(p.get());
        set.Set(p.name, p.range.min + (value - p.range.min) * 0.87654321);
      }
    }
  }
  Write(WriteConfig(written.Parameters()));
  Load(path_, &options_);
  EXPECT_EQ(ValuesOf(&options_), ValuesOf(&written));
  SlamOptions defaults;
  EXPECT_NE(ValuesOf(&options_), ValuesOf(&defaults));
}

TEST(WriteConfig, TellsUnitAndRangeAboveEachValue) {
  double width = 0.5;
  double depth = 2.0;
  bool dry = true;
  ParameterSet set("painter");
  set.Add("dry", &dry, "a switch");
  set.Add("brush/width", &width, "m", {0.0, 1.0}, "of the brush");
  set.Add("brush/depth", &depth, "m", {0.0, 1e9}, "of the paint");
  EXPECT_EQ(WriteConfig({set}),
            "painter:\n"
            "  # a switch\n"
            "  dry: true\n"
            "  brush:\n"
            "    # of the brush [m], 0.0 to 1.0\n"
            "    width: 0.5\n"
            "    # of the paint [m], not negative\n"
            "    depth: 2.0\n");
}

struct Scalar {
  const char* text;
  ParameterValue value;
};

class ParseScalar : public ::testing::TestWithParam<Scalar> {};

TEST_P(ParseScalar, TellsTypesApartAsRosparamDoes) {
  EXPECT_EQ(ParseParameterValue(GetParam().text), GetParam().value) << GetParam().text;
}

INSTANTIATE_TEST_SUITE_P(
    Table, ParseScalar,
    ::testing::Values(Scalar{"true", true}, Scalar{"False", false}, Scalar{"YES", true},
                      Scalar{"off", false}, Scalar{"7", 7}, Scalar{"-7", -7}, Scalar{"7.0", 7.0},
                      Scalar{"-0.5", -0.5}, Scalar{"1.5e3", 1500.0},
                      Scalar{"99999999999", 1e11 - 1}, Scalar{"", std::string("")},
                      Scalar{"y", std::string("y")}, Scalar{"7 m", std::string("7 m")},
                      Scalar{"0x1F", std::string("0x1F")}, Scalar{"nan", std::string("nan")},
                      Scalar{"1.2.3", std::string("1.2.3")}));

}  // namespace
}  // namespace scan_image_slam
