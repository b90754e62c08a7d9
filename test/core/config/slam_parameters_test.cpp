#include "scan_image_slam/core/config/slam_parameters.h"

#include <cmath>
#include <set>
#include <stdexcept>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

double Number(const ParameterValue& value) {
  if (const int* i = std::get_if<int>(&value)) return *i;
  return std::get<double>(value);
}

bool IsNumber(const Parameter& p) { return p.type == "int" || p.type == "double"; }

/// Calls `check(set, parameter)` for each parameter of the system.
template <typename Check>
void ForEachParameter(SlamOptions* options, const Check& check) {
  for (ParameterSet& set : options->Parameters()) {
    for (const Parameter& p : set.parameters()) {
      SCOPED_TRACE(set.node() + "/" + p.name);
      check(set, p);
    }
  }
}

TEST(SlamParameters, AreThoseOfTheThreeNodes) {
  SlamOptions options;
  std::vector<std::string> nodes;
  for (const ParameterSet& set : options.Parameters()) nodes.push_back(set.node());
  EXPECT_EQ(nodes, (std::vector<std::string>{"scan_image_fusion", "bounded_icp", "mapper"}));
}

TEST(SlamParameters, AreDescribedWithTheirUnit) {
  SlamOptions options;
  ForEachParameter(&options, [](const ParameterSet&, const Parameter& p) {
    EXPECT_GE(p.description.size(), 10U);
    EXPECT_FALSE(p.unit.empty());
    EXPECT_EQ(p.description.find('['), std::string::npos) << "the unit is added by itself";
    const bool degrees = p.name.size() > 4 && p.name.substr(p.name.size() - 4) == "_deg";
    EXPECT_EQ(p.unit == "deg", degrees);
  });
}

TEST(SlamParameters, HaveARangeThatHoldsTheDefault) {
  SlamOptions options;
  ForEachParameter(&options, [](const ParameterSet&, const Parameter& p) {
    if (!IsNumber(p)) return;
    EXPECT_TRUE(std::isfinite(p.range.min) && std::isfinite(p.range.max));
    EXPECT_LT(p.range.min, p.range.max);
    EXPECT_GE(Number(p.get()), p.range.min);
    EXPECT_LE(Number(p.get()), p.range.max);
  });
}

TEST(SlamParameters, HaveADefaultAmongTheirChoices) {
  SlamOptions options;
  int choices = 0;
  ForEachParameter(&options, [&](const ParameterSet&, const Parameter& p) {
    if (p.choices.empty()) return;
    ++choices;
    const auto value = std::get<std::string>(p.get());
    EXPECT_NE(std::find(p.choices.begin(), p.choices.end(), value), p.choices.end()) << value;
  });
  EXPECT_EQ(choices, 4);  // odom_source twice, reference, no_return_policy
}

TEST(SlamParameters, HaveNoNameTwice) {
  SlamOptions options;
  std::set<std::string> names;
  ForEachParameter(&options, [&](const ParameterSet& set, const Parameter& p) {
    EXPECT_TRUE(names.insert(set.node() + "/" + p.name).second);
  });
}

TEST(SlamParameters, OfOneGroupStandTogether) {
  // Otherwise the yaml file would hold the group twice, and the last one would win.
  SlamOptions options;
  std::set<std::string> closed;
  std::string group;
  ForEachParameter(&options, [&](const ParameterSet& set, const Parameter& p) {
    const std::string whole = set.node() + "/" + p.name;
    const std::string its_group = whole.substr(0, whole.rfind('/'));
    if (its_group == group) return;
    const bool root = group == set.node() || its_group == set.node();
    EXPECT_TRUE(closed.insert(its_group).second || root);
    group = its_group;
  });
}

TEST(SlamParameters, ThatShapeWhatIsKeptAreNotLive) {
  SlamOptions options;
  std::set<std::string> live;
  ForEachParameter(&options, [&](const ParameterSet& set, const Parameter& p) {
    if (p.live) live.insert(set.node() + "/" + p.name);
    EXPECT_FALSE(p.type == "string" && p.live);
  });
  EXPECT_EQ(live.count("bounded_icp/refinement/gate"), 1U);
  for (const char* name :
       {"mapper/resolution", "mapper/map_max_range", "mapper/loop/enabled",
        "mapper/keyframe_distance", "bounded_icp/local_map/spacing", "bounded_icp/local_map/reach",
        "bounded_icp/laser/range_stddev", "bounded_icp/search/distance_step"}) {
    EXPECT_EQ(live.count(name), 0U) << name;
  }
}

/// Another value that the parameter may have.
ParameterValue Other(const Parameter& p) {
  if (p.type == "bool") return !std::get<bool>(p.get());
  if (p.type == "string") {
    const auto value = std::get<std::string>(p.get());
    if (p.choices.empty()) return value + "_other";
    return p.choices.front() == value ? p.choices.back() : p.choices.front();
  }
  const double value = Number(p.get());
  const double other = value + 1.0 <= p.range.max ? value + 1.0 : 0.5 * (value + p.range.min);
  return p.type == "int" ? ParameterValue(static_cast<int>(other)) : ParameterValue(other);
}

TEST(SlamParameters, EachHasAFieldOfItsOwn) {
  SlamOptions options;
  std::vector<ParameterSet> sets = options.Parameters();
  const auto values = [&] {
    std::vector<ParameterValue> all;
    for (const ParameterSet& set : sets) {
      for (const Parameter& p : set.parameters()) all.push_back(p.get());
    }
    return all;
  };
  std::size_t index = 0;
  for (ParameterSet& set : sets) {
    for (const Parameter& p : set.parameters()) {
      const std::vector<ParameterValue> before = values();
      const ParameterValue other = Other(p);
      ASSERT_NE(other, p.get());
      set.Set(p.name, other);
      const std::vector<ParameterValue> after = values();
      for (std::size_t i = 0; i < after.size(); ++i) {
        EXPECT_EQ(after[i] != before[i], i == index) << set.node() << "/" << p.name << " " << i;
      }
      ++index;
    }
  }
  EXPECT_GT(index, 100U);
}

/// Builds what the options are for; the error of it, or nothing.
std::string ErrorOf(const SlamOptions& options) {
  try {
    ScanImageFusion fusion(options.fusion);
    BoundedIcp bounded_icp(options.bounded_icp);
    Mapper mapper(options.mapper);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(SlamParameters, WhatIsInRangeIsAcceptedOrRefusedByName) {
  // Some exclude each other, e.g. min_range and max_range: then the error names one of them.
  SlamOptions defaults;
  std::set<std::string> refused;
  ForEachParameter(&defaults, [&](const ParameterSet& set, const Parameter& p) {
    if (!IsNumber(p)) return;
    for (const double value : {p.range.min, p.range.max}) {
      SlamOptions options;
      for (ParameterSet& other : options.Parameters()) {
        if (other.node() != set.node()) continue;
        other.Set(p.name, p.type == "int" ? ParameterValue(static_cast<int>(value))
                                          : ParameterValue(value));
      }
      const std::string error = ErrorOf(options);
      if (!error.empty()) refused.insert(p.name + ": " + error);
    }
  });
  EXPECT_EQ(refused,
            (std::set<std::string>{"max_range: max_range must be greater than min_range",
                                   "min_range: max_range must be greater than min_range"}));
}

}  // namespace
}  // namespace scan_image_slam
