#include "scan_image_slam/core/config/foreign_names.h"

#include "scan_image_slam/core/config/slam_parameters.h"

#include <set>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

/// Names of our parameters, with their node or without.
std::set<std::string> OwnNames(bool with_node) {
  SlamOptions options;
  std::set<std::string> names;
  for (const ParameterSet& set : options.Parameters()) {
    for (const Parameter& p : set.parameters()) {
      names.insert(with_node ? set.node() + "/" + p.name : p.name);
    }
  }
  return names;
}

TEST(ForeignNames, LeadToParametersThatExist) {
  const std::set<std::string> own = OwnNames(true);
  for (const ForeignName& foreign : ForeignNames()) {
    for (const std::string& name : foreign.here) {
      EXPECT_EQ(own.count(name), 1U) << foreign.name << " -> " << name;
    }
  }
}

TEST(ForeignNames, AreNoneOfOurOwn) {
  const std::set<std::string> own = OwnNames(false);
  for (const ForeignName& foreign : ForeignNames()) {
    EXPECT_EQ(own.count(foreign.name), 0U) << foreign.name;
  }
}

TEST(ForeignNames, AreThereOnceAndInOrder) {
  std::string last;
  for (const ForeignName& foreign : ForeignNames()) {
    EXPECT_LT(last, foreign.name);
    last = foreign.name;
  }
}

TEST(ForeignNames, SayWhatToDoIfThereIsNoCounterpart) {
  for (const ForeignName& foreign : ForeignNames()) {
    EXPECT_FALSE(foreign.here.empty() && foreign.remark.empty()) << foreign.name;
  }
}

TEST(ForeignNames, AreFoundByTheirName) {
  ASSERT_NE(FindForeignName("delta"), nullptr);
  EXPECT_EQ(FindForeignName("delta")->packages, "gmapping");
  EXPECT_EQ(FindForeignName("map_size")->packages, "hector_mapping");
  EXPECT_EQ(FindForeignName("Delta"), nullptr);
}

TEST(ForeignNames, AreExplainedInOneSentence) {
  EXPECT_EQ(Explain({"delta", "gmapping", {"mapper/resolution"}, ""}),
            "a parameter of gmapping, not used; use mapper/resolution");
  EXPECT_EQ(Explain({"a", "b, c", {"mapper/d", "mapper/e"}, "both"}),
            "a parameter of b, c, not used; use mapper/d and mapper/e (both)");
  EXPECT_EQ(Explain({"xmin", "gmapping", {}, "the map grows"}),
            "a parameter of gmapping, not used; there is nothing like it here (the map grows)");
}

}  // namespace
}  // namespace scan_image_slam
