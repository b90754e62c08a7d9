#include "scan_image_slam/core/mapping/known_places.h"

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

/// Four visits, each of three places 1 m apart: keyframe 3 k + i is that of visit k to place i. The
/// later visits were recognised by the first, and what they saw was let go.
class FourVisits : public ::testing::Test {
 protected:
  static constexpr int kPlaces = 3;
  static constexpr int kKeyframes = 4 * kPlaces;

  FourVisits() {
    for (int id = 0; id < kKeyframes; ++id) {
      auto keyframe = std::make_shared<Keyframe>();
      keyframe->id = id;
      if (id < kPlaces) keyframe->points.resize(10);
      keyframes_[id] = keyframe;
      poses_[id] = {1.0 * (id % kPlaces), 0.1 * (id / kPlaces), 0.1};
      if (id > 0) Join(id - 1, id, false);
      if (id >= kPlaces) Join(id % kPlaces, id, true);
    }
  }
  void Join(int from, int to, bool closes_loop) {
    GraphConstraint constraint;
    constraint.from = from;
    constraint.to = to;
    constraint.from_from_to = {0.3, 0.3, 0.4};
    constraint.information = 400.0 * Eigen::Matrix3d::Identity();
    constraint.robust = closes_loop;
    constraint.overlap = closes_loop ? 0.95 : 0.0;
    const int index = static_cast<int>(constraints_.size());
    links_[from].push_back({to, index, 1.0});
    links_[to].push_back({from, index, 1.0});
    constraints_.push_back(constraint);
  }
  GraphConstraint& Closure(int to) {
    for (GraphConstraint& c : constraints_) {
      if (c.to == to && c.closes_loop()) return c;
    }
    throw std::logic_error("no closure");
  }
  KnownPlaces Places() const {
    return KnownPlaces(keyframes_, poses_, constraints_, links_, options_);
  }

  /// As if it had not been judged yet.
  void SeesSomething(int id) {
    auto keyframe = std::make_shared<Keyframe>(*keyframes_.at(id));
    keyframe->points.resize(10);
    keyframes_[id] = keyframe;
  }

  Keyframes keyframes_;
  GraphPoses poses_;
  std::vector<GraphConstraint> constraints_;
  GraphLinks links_;
  KnownPlaceOptions options_;
};

TEST_F(FourVisits, TheFirstVisitKnowsThePlaceOfTheLater) {
  EXPECT_FALSE(Places().AnchorOf(1));
  EXPECT_EQ(Places().AnchorOf(4), 1);
  EXPECT_EQ(Places().AnchorOf(11), 2);
}

TEST_F(FourVisits, AKeyframeThatSawMoreOrElsewhereIsNotKnown) {
  for (const int id : {3, 4, 5}) SeesSomething(id);
  EXPECT_EQ(Places().AnchorOf(3), 0);
  Closure(3).overlap = 0.85;
  EXPECT_FALSE(Places().AnchorOf(3));
  Closure(4).from_from_to = {0.4, 0.4, 0.0};
  EXPECT_FALSE(Places().AnchorOf(4));
  Closure(5).from_from_to = {0.0, 0.0, -0.6};
  EXPECT_FALSE(Places().AnchorOf(5));
}

TEST_F(FourVisits, OfAPlaceThatIsSeenAnewEachTimeAFewViewsAreKept) {
  for (int id = 3; id < kKeyframes; ++id) {
    SeesSomething(id);
    Closure(id).overlap = 0.85;
  }
  options_.max_views = 3;
  EXPECT_FALSE(Places().AnchorOf(7));  // two before it
  EXPECT_EQ(Places().AnchorOf(10), 1);
  poses_[7].theta += 0.6;
  EXPECT_FALSE(Places().AnchorOf(10)) << "a view in another direction is another view";
  poses_[7].theta -= 0.6;
  poses_[7].x += 0.6;
  EXPECT_FALSE(Places().AnchorOf(10)) << "from elsewhere, too";
  poses_[7].x -= 0.6;
  Closure(10).from_from_to = {0.4, 0.4, 0.0};
  EXPECT_FALSE(Places().AnchorOf(10)) << "nobody near knows it";
  Closure(10).from_from_to = {0.1, 0.1, 3.0};
  EXPECT_EQ(Places().AnchorOf(10), 1);
}

TEST_F(FourVisits, WhatWasJudgedOnceStaysKnown) {
  Closure(4).overlap = 0.85;
  EXPECT_EQ(Places().AnchorOf(4), 1);
}

TEST_F(FourVisits, AKeyframeWithoutPointsIsNoAnchor) {
  keyframes_[1] = std::make_shared<Keyframe>();
  EXPECT_FALSE(Places().AnchorOf(4));
}

TEST_F(FourVisits, TheGraphIsTheBetterForThreeVisitsMore) {
  EXPECT_FALSE(Places().IsNeedless(7));
  EXPECT_FALSE(Places().IsNeedless(10));  // only two between the first and it
  options_.max_visits = 2;
  EXPECT_FALSE(Places().IsNeedless(7));
  EXPECT_TRUE(Places().IsNeedless(10));
}

TEST_F(FourVisits, NeighboursHoldTheGraphTogether) {
  options_.max_visits = 2;
  for (const int id : {9, 11}) SeesSomething(id);
  EXPECT_TRUE(Places().IsNeedless(10));
  Closure(11).overlap = 0.5;
  EXPECT_FALSE(Places().IsNeedless(10));
  Closure(11).overlap = 0.95;
  Closure(9).overlap = 0.5;
  EXPECT_FALSE(Places().IsNeedless(10));
  keyframes_.erase(9);  // was let go, which is for what is known only
  EXPECT_TRUE(Places().IsNeedless(10));
}

TEST_F(FourVisits, TheWayPastWhatIsLeftOutIsKept) {
  const std::vector<GraphConstraint> kept = Without({{4, {}}, {5, {}}}, constraints_);
  EXPECT_EQ(kept.size(), constraints_.size() - 2 - 2);  // closures; two of three steps
  std::vector<int> ways;
  for (const GraphConstraint& c : kept) {
    if (!c.closes_loop()) ways.push_back(c.from);
    if (c.closes_loop() || c.from != 3) continue;
    EXPECT_EQ(c.to, 6);
    const Pose2 step{0.3, 0.3, 0.4};
    const Pose2 apart = (step * step * step).Inverse() * c.from_from_to;
    EXPECT_LT(apart.coordinates().norm(), 1e-12);
  }
  EXPECT_EQ(ways, (std::vector<int>{0, 1, 2, 3, 6, 7, 8, 9, 10}));
  // What is left out later is left out of what was left.
  const std::vector<GraphConstraint> less = Without({{7, {}}}, kept);
  EXPECT_EQ(less.size(), kept.size() - 2);
}

TEST_F(FourVisits, AMotionThatMayBeWrongIsNoRecognisedPlace) {
  for (GraphConstraint& c : constraints_) {
    if (c.from == 4 && c.to == 5) c.robust = true;  // the matching could not follow
  }
  EXPECT_FALSE(Places().AnchorOf(5) == 4);
  int past = 0;
  for (const GraphConstraint& c : Without({{5, {}}}, constraints_)) {
    past += c.from == 4 && c.to == 6 && c.robust ? 1 : 0;
  }
  EXPECT_EQ(past, 1);
}

TEST_F(FourVisits, WhatIsKeptIsNeeded) {
  options_.max_visits = 2;
  keyframes_[10] = keyframes_[0];
  EXPECT_FALSE(Places().IsNeedless(10));
}

}  // namespace
}  // namespace scan_image_slam
