#include "grid_fixtures.h"
#include "mapper_fixtures.h"
#include "scan_image_slam/core/mapping/mapper.h"
#include "support_rooms.h"

#include <limits>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

constexpr int kAll = std::numeric_limits<int>::max();

/// A drive of 4.8 m through a room, matched without an error: each scan is drawn, every fourth is
/// kept.
class MapperCorrection : public ::testing::Test {
 protected:
  MapperCorrection() : mapper_(MapperOptions()) {
    for (int i = 0; i <= 40; ++i) {
      const Pose2 pose{-2.4 + 0.12 * i, 0.5, 0.0};
      poses_.push_back(pose);
      const MatchedMotion match =
          MatchAt(kStart, kStart + i * 25'000'000LL, poses_.front().Inverse() * pose, pose);
      models_.push_back(ModelOf(FurnishedRoom(), pose, match.stamp, TestLaser()));
      matches_.push_back(match);
      mapper_.AddMatch(match);
      if (const auto keyframe = mapper_.AddModel(models_.back(), match)) {
        keyframes_.push_back(keyframe);
        keyframe_poses_[keyframe->id] = pose;
      }
    }
  }

  static constexpr Stamp kStart = 1'000'000'000LL;
  Mapper mapper_;
  std::vector<Pose2> poses_;
  std::vector<FusedModel> models_;
  std::vector<MatchedMotion> matches_;
  std::vector<std::shared_ptr<const Keyframe>> keyframes_;
  GraphPoses keyframe_poses_;
};

TEST_F(MapperCorrection, KeepsAKeyframeWhereTheRobotHasMoved) {
  ASSERT_EQ(keyframes_.size(), 11U);
  EXPECT_EQ(keyframes_.front()->id, 0);
  EXPECT_NEAR(keyframes_.front()->previous_from_base.x, -2.4, 1e-12);
  for (std::size_t i = 1; i < keyframes_.size(); ++i) {
    EXPECT_EQ(keyframes_[i]->id, static_cast<int>(i));
    EXPECT_TRUE(keyframes_[i]->joined);
    EXPECT_NEAR(keyframes_[i]->previous_from_base.x, 0.48, 1e-9);
    EXPECT_NEAR(keyframes_[i]->way, 0.48 * static_cast<double>(i), 1e-9);
  }
}

TEST_F(MapperCorrection, MovesEveryPoseWithItsKeyframe) {
  // The second half of the drive is turned about its first keyframe.
  GraphPoses corrected = keyframe_poses_;
  const Pose2 turn = keyframe_poses_[5] * Pose2{0.0, 0.0, 0.1} * keyframe_poses_[5].Inverse();
  for (auto pose = corrected.find(5); pose != corrected.end(); ++pose) {
    pose->second = turn * pose->second;
  }
  mapper_.Correct(corrected, {});
  const std::vector<MapPose> trajectory = mapper_.Trajectory();
  ASSERT_EQ(trajectory.size(), poses_.size());
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    // The first scan of a keyframe was tracked before it was kept: it hangs on the one before.
    const bool turned = i > 20;
    const Pose2 expected = turned ? turn * poses_[i] : poses_[i];
    EXPECT_EQ(trajectory[i].stamp, matches_[i].stamp);
    EXPECT_NEAR((trajectory[i].map_from_base.translation() - expected.translation()).norm(), 0.0,
                1e-9)
        << i;
  }
  const MatchedMotion next =
      MatchAt(kStart, kStart + 2'000'000'000LL, poses_.front().Inverse() * Pose2{2.5, 0.5, 0.0});
  const Pose2 goes_on = mapper_.AddMatch(next).map_from_base;
  const Pose2 expected = turn * Pose2{2.5, 0.5, 0.0};
  EXPECT_NEAR((goes_on.translation() - expected.translation()).norm(), 0.0, 1e-9);
}

TEST_F(MapperCorrection, LeavesKeyframesThatCameLaterWhereTheyLieToTheLastCorrected) {
  GraphPoses corrected(keyframe_poses_.begin(), keyframe_poses_.find(4));
  const Pose2 shift{0.3, -0.2, 0.0};
  for (auto& [id, pose] : corrected) pose = shift * pose;
  mapper_.Correct(corrected, {});
  for (const MapPose& pose : mapper_.Trajectory()) {
    const std::size_t i = static_cast<std::size_t>((pose.stamp - kStart) / 25'000'000LL);
    if (i == 0) continue;  // before the first keyframe
    EXPECT_NEAR(pose.map_from_base.x, poses_[i].x + 0.3, 1e-9);
    EXPECT_NEAR(pose.map_from_base.y, poses_[i].y - 0.2, 1e-9);
  }
}

TEST_F(MapperCorrection, TheRedrawnMapIsThatOfTheCorrectedPosesBitForBit) {
  GraphPoses corrected;
  const Pose2 moved{0.4, 0.15, 0.07};
  for (const auto& [id, pose] : keyframe_poses_) corrected[id] = moved * pose;
  mapper_.Correct(corrected, {});
  EXPECT_FALSE(mapper_.Redraw(3));  // a few at a time
  EXPECT_TRUE(mapper_.Redraw(kAll));

  Mapper fresh{MapperOptions()};
  fresh.SetPose(corrected.at(0));
  for (std::size_t i = 0; i < matches_.size(); ++i) {
    MatchedMotion match = matches_[i];
    match.odom_from_base.reset();
    fresh.AddMatch(match);
    fresh.AddModel(models_[i], match);
  }
  ASSERT_GT(DrawnCells(fresh), 1000);
  ExpectSameOccupancy(mapper_.grid(), fresh.grid());
}

TEST_F(MapperCorrection, IgnoresPosesOfMoreKeyframesThanThereAre) {
  GraphPoses foreign;
  for (int id = 0; id <= static_cast<int>(keyframe_poses_.size()); ++id) foreign[id] = {9, 9, 0};
  mapper_.Correct(foreign, {});
  mapper_.Correct({}, {});
  EXPECT_NEAR(mapper_.Trajectory().back().map_from_base.x, poses_.back().x, 1e-9);
}

TEST_F(MapperCorrection, WhatHangsOnAKeyframeThatWasLetGoHangsOnItsAnchor) {
  const Pose2 two_from_five = keyframe_poses_[2].Inverse() * keyframe_poses_[5];
  GraphPoses left = keyframe_poses_;
  left.erase(5);
  mapper_.Correct(left, {{5, {2, two_from_five}}});
  const std::vector<MapPose> trajectory = mapper_.Trajectory();
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    EXPECT_NEAR((trajectory[i].map_from_base.translation() - poses_[i].translation()).norm(), 0.0,
                1e-9);
  }
  // The next keyframe has a number of its own, and who moves the anchor moves all.
  const MatchedMotion next =
      MatchAt(kStart, kStart + 2'000'000'000LL, poses_.front().Inverse() * Pose2{2.9, 0.5, 0.0});
  mapper_.AddMatch(next);
  const auto keyframe = mapper_.AddModel(models_.back(), next);
  ASSERT_NE(keyframe, nullptr);
  EXPECT_EQ(keyframe->id, 11);
  left[2] = Pose2{0.0, 0.3, 0.0} * left[2];
  mapper_.Correct(left, {{5, {2, two_from_five}}});
  EXPECT_TRUE(mapper_.Redraw(kAll));
  int moved = 0;
  for (const MapPose& pose : mapper_.Trajectory()) moved += pose.map_from_base.y > 0.79 ? 1 : 0;
  EXPECT_EQ(moved, 8) << "four scans of keyframe 2 and four of keyframe 5";
  moved = 0;
  for (const DrawnScan& drawn : mapper_.State().drawn) {
    EXPECT_NE(drawn.pose.keyframe, 5);
    moved += drawn.map_from_base.y > 0.79 ? 1 : 0;
  }
  EXPECT_EQ(moved, 8);
}

TEST_F(MapperCorrection, AStateMayHoldScansOfAKeyframeThatWasLetGo) {
  MapState state = mapper_.State();
  for (const auto& keyframe : keyframes_) state.graph.keyframes[keyframe->id] = keyframe;
  state.graph.poses = keyframe_poses_;
  state.graph.keyframes.erase(5);
  state.graph.poses.erase(5);
  state.graph.let_go[5] = {2, keyframe_poses_[2].Inverse() * keyframe_poses_[5]};
  Mapper loaded{MapperOptions()};
  loaded.Load(state, MapUse::kContinue);
  EXPECT_TRUE(loaded.Redraw(kAll));
  ExpectSameOccupancy(loaded.grid(), mapper_.grid());
  for (const DrawnScan& drawn : loaded.State().drawn) EXPECT_NE(drawn.pose.keyframe, 5);
}

TEST(MapperTrajectory, ALongOneIsThinnedEvenly) {
  MapperOptions options;
  options.max_trajectory_poses = 100;
  Mapper mapper(options);
  constexpr double kStep = 0.02;
  constexpr int kSteps = 2000;
  for (int i = 0; i < kSteps; ++i) mapper.AddMatch(MatchAt(0, i, {kStep * i, 0.0, 0.0}));
  const std::vector<MapPose> trajectory = mapper.Trajectory();
  ASSERT_GT(trajectory.size(), 50U);
  ASSERT_LE(trajectory.size(), 100U);
  EXPECT_EQ(trajectory.front().stamp, 0);
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    const double spacing = trajectory[i].map_from_base.x - trajectory[i - 1].map_from_base.x;
    EXPECT_GT(spacing, kStep * kSteps / 200);
    EXPECT_LT(spacing, kStep * kSteps / 40);
    EXPECT_NEAR(trajectory[i].map_from_base.x, kStep * static_cast<double>(trajectory[i].stamp),
                1e-9);
  }
  EXPECT_GT(trajectory.back().map_from_base.x, kStep * kSteps * 0.95);
}

/// The keyframe after so many matches in a row that failed.
class MapperGap : public MapperCorrection {
 protected:
  MatchedMotion NextMatch(double x) {
    stamp_ += 100'000'000LL;
    return MatchAt(kStart, stamp_, poses_.front().Inverse() * Pose2{x, 0.5, 0.0});
  }

  void Fail(int failures) {
    for (int i = 0; i < failures; ++i) {
      MatchedMotion lost = NextMatch(2.6);
      lost.status = MatchStatus::kTooFewPoints;
      mapper_.AddMatch(lost);
      EXPECT_EQ(mapper_.AddModel(models_.back(), lost), nullptr);
    }
  }

  std::shared_ptr<const Keyframe> KeyframeAfter(int failures) {
    Fail(failures);
    const MatchedMotion again = NextMatch(2.9);
    mapper_.AddMatch(again);
    return mapper_.AddModel(models_.back(), again);
  }

  Stamp stamp_ = kStart + 1'000'000'000LL;
};

TEST_F(MapperGap, ABriefOneIsNoBreak) {
  const auto keyframe = KeyframeAfter(5);
  ASSERT_NE(keyframe, nullptr);
  EXPECT_TRUE(keyframe->joined);
  EXPECT_LT(keyframe->covariance(0, 0), 0.01);
}

TEST_F(MapperGap, TwoBriefOnesAreNoBreak) {
  Fail(4);
  mapper_.AddMatch(NextMatch(2.6));
  const auto keyframe = KeyframeAfter(4);
  ASSERT_NE(keyframe, nullptr);
  EXPECT_TRUE(keyframe->joined);
}

TEST_F(MapperGap, ALongOneIsMarkedAsABreak) {
  const auto keyframe = KeyframeAfter(6);
  ASSERT_NE(keyframe, nullptr);
  EXPECT_FALSE(keyframe->joined);
  EXPECT_GE(keyframe->covariance(0, 0), 1.0);
}

}  // namespace
}  // namespace scan_image_slam
