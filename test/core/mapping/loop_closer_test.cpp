#include "scan_image_slam/core/mapping/loop_closer.h"

#include "loop_fixtures.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

GraphPoses PosesAfter(const DriftingDrive& drive, LoopCloser* closer) {
  for (const auto& keyframe : drive.keyframes) closer->Add(keyframe);
  return closer->poses();
}

TEST(LoopCloser, ASecondRoundTakesTheDriftAway) {
  // Turns are off by six times what they claim together: what is found must count all the same.
  const DriftingDrive drive = Drive(RingOfCorridors(), TwiceAroundTheRing(), {1.005, 0.0006});
  LoopCloserOptions off;
  off.enabled = false;
  LoopCloser without(off);
  LoopCloser with{LoopCloserOptions()};
  EXPECT_FALSE(without.Add(drive.keyframes.front()));
  // The drive adds up its motions to this much error; the closer has to find the way back.
  Pose2 chained = drive.truth.front();
  for (std::size_t i = 1; i < drive.keyframes.size(); ++i) {
    chained = chained * drive.keyframes[i]->previous_from_base;
  }
  const double drifted = (chained.translation() - drive.truth.back().translation()).norm();
  ASSERT_GT(drifted, 0.5);
  const GraphPoses poses = PosesAfter(drive, &with);
  EXPECT_GT(with.closures(), 10);
  // What is left is the bend of the first round, which nothing contradicts at its far side.
  EXPECT_LT(LargestError(poses, drive.truth), 0.3 * drifted);
  EXPECT_LT((poses.rbegin()->second.translation() - drive.truth.back().translation()).norm(), 0.05);
}

TEST(LoopCloser, TheSameKeyframesGiveTheSameBits) {
  const DriftingDrive drive = Drive(RingOfCorridors(), TwiceAroundTheRing(), {1.005, 0.0005});
  LoopCloser first{LoopCloserOptions()};
  LoopCloser second{LoopCloserOptions()};
  ExpectSameBits(PosesAfter(drive, &first), PosesAfter(drive, &second));
}

TEST(LoopCloser, GoesOnFromItsMemoryAsIfItHadNotStopped) {
  const DriftingDrive drive = Drive(RingOfCorridors(), TwiceAroundTheRing(), {1.005, 0.0005});
  LoopCloser whole{LoopCloserOptions()};
  PosesAfter(drive, &whole);
  LoopCloser first{LoopCloserOptions()};
  const std::size_t half = 3 * drive.keyframes.size() / 4;  // some loops are closed already
  for (std::size_t i = 0; i < half; ++i) first.Add(drive.keyframes[i]);
  ASSERT_GT(first.closures(), 5);
  LoopCloser second{LoopCloserOptions()};
  second.Add(drive.keyframes.front());  // what it knew before is gone
  second.Load(first.memory());
  for (std::size_t i = half; i < drive.keyframes.size(); ++i) second.Add(drive.keyframes[i]);
  EXPECT_EQ(second.closures(), whole.closures());
  ExpectSameBits(second.poses(), whole.poses());
}

int WithPoints(const LoopCloser& closer) {
  const GraphMemory memory = closer.memory();
  return static_cast<int>(std::count_if(memory.keyframes.begin(), memory.keyframes.end(),
                                        [](const auto& k) { return !k.second->points.empty(); }));
}

// A round is 110 keyframes. From the sixth on the graph has all visits that it wants.
TEST(LoopCloser, AKnownBuildingNeedsNoMoreMemory) {
  const DriftingDrive drive = Drive(RingOfCorridors(), AroundTheRing(10), {1.002, 0.0002});
  LoopCloser closer{LoopCloserOptions()};
  std::vector<int> points;
  std::vector<std::size_t> keyframes;
  std::vector<std::size_t> constraints;
  for (std::size_t i = 0; i < drive.keyframes.size(); ++i) {
    closer.Add(drive.keyframes[i]);
    if ((i + 1) % 110 != 0) continue;
    points.push_back(WithPoints(closer));
    keyframes.push_back(closer.poses().size());
    constraints.push_back(closer.constraints().size());
  }
  ASSERT_EQ(points.size(), 9U);
  // The first round is kept, and of later ones what is not recognised and the last few metres.
  EXPECT_GT(points[1], 100);
  EXPECT_LT(points.back(), 140);
  EXPECT_LT(constraints.back(), 1.3 * constraints[5]);
  EXPECT_LT(keyframes.back(), 1.3 * keyframes[5]);
  EXPECT_LT(LargestError(closer.poses(), drive.truth), 0.1);
  // Each keyframe is there, or was let go and is known to lie at another, where it truly was.
  const Anchors let_go = closer.let_go();
  EXPECT_EQ(let_go.size() + closer.poses().size(), drive.truth.size());
  GraphPoses anchored;
  for (const auto& [id, anchor] : let_go) anchored[id] = MapFromBase(anchor, closer.poses());
  EXPECT_LT(LargestError(anchored, drive.truth), 0.1);
  // The motion of a keyframe is the longer and the less certain for those that went before it.
  const GraphMemory memory = closer.memory();
  int before = 0;
  for (const auto& [id, keyframe] : memory.keyframes) {
    const int motions = std::max(1, id - before);
    EXPECT_NEAR(keyframe->covariance(2, 2), ClaimedOfAMotion()(2, 2) * motions, 1e-9) << id;
    before = id;
  }
  // As soon as nothing hangs on them, they are forgotten.
  closer.ForgetLetGo(static_cast<int>(drive.keyframes.size()) / 2);
  EXPECT_LT(closer.let_go().size(), let_go.size());
  EXPECT_GT(closer.let_go().size(), 0U);
  closer.ForgetLetGo(static_cast<int>(drive.keyframes.size()));
  EXPECT_EQ(closer.let_go().size(), 0U);
}

TEST(LoopCloser, NorDoesItIfLoopsAreNotClosed) {
  const DriftingDrive drive = Drive(RingOfCorridors(), AroundTheRing(10), {1.0, 0.0});
  LoopCloserOptions options;
  options.enabled = false;
  LoopCloser closer(options);
  for (const auto& keyframe : drive.keyframes) EXPECT_FALSE(closer.Add(keyframe));
  EXPECT_LT(WithPoints(closer), 600);  // five rounds of ten, and the last few metres
}

TEST(LoopCloser, GoesOnFromAMemoryThatLacksWhatIsKnown) {
  const DriftingDrive drive = Drive(RingOfCorridors(), AroundTheRing(8), {1.002, 0.0002});
  LoopCloser whole{LoopCloserOptions()};
  LoopCloser second{LoopCloserOptions()};
  const std::size_t half = 7 * drive.keyframes.size() / 8;
  for (std::size_t i = 0; i < drive.keyframes.size(); ++i) {
    if (i == half) {
      ASSERT_GT(whole.let_go().size(), 100U);
      second.Load(whole.memory());
      whole.ForgetLetGo(static_cast<int>(i));
    }
    whole.Add(drive.keyframes[i]);
    if (i >= half) second.Add(drive.keyframes[i]);
  }
  EXPECT_EQ(second.closures(), whole.closures());
  EXPECT_EQ(second.let_go().size(), whole.let_go().size());
  ExpectSameBits(second.poses(), whole.poses());
}

TEST(LoopCloser, KeyframeZeroStartsANewMap) {
  const DriftingDrive drive = Drive(RingOfCorridors(), TwiceAroundTheRing(), {1.005, 0.0005});
  LoopCloser closer{LoopCloserOptions()};
  PosesAfter(drive, &closer);
  closer.Add(drive.keyframes.front());
  EXPECT_EQ(closer.poses().size(), 1U);
  EXPECT_EQ(closer.closures(), 0);
}

/// Along a corridor there are rooms of one size and shape every 4 m, each seen through its door.
Room CorridorOfEqualRooms(int rooms) {
  constexpr double kPitch = 4.0;
  Room room = {
      {{0, 0}, {kPitch * rooms, 0}}, {{0, 0}, {0, 2}}, {{kPitch * rooms, 0}, {kPitch * rooms, 2}}};
  for (int i = 0; i < rooms; ++i) {
    const double x = kPitch * i;
    room = room + Room{{{x, 2}, {x + 1.5, 2}},
                       {{x + 2.5, 2}, {x + kPitch, 2}},
                       {{x + 0.1, 2.1}, {x + 0.1, 6}},
                       {{x + 0.1, 6}, {x + 3.9, 6}},
                       {{x + 3.9, 2.1}, {x + 3.9, 6}}};
  }
  return room;
}

TEST(LoopCloser, EqualRoomsAlongACorridorAreNotTakenForOneAnother) {
  // Down a corridor of 48 m, each room looks like the one before; none is ever seen again.
  const Room room = CorridorOfEqualRooms(12);
  const DriftingDrive drive = Drive(room, {{1, 1}, {47, 1}}, {1.01, 0.0});
  LoopCloser closer{LoopCloserOptions()};
  const GraphPoses poses = PosesAfter(drive, &closer);
  EXPECT_EQ(closer.closures(), 0);
}

TEST(LoopCloser, EqualRoomsOnTheWayBackAreThoseOfTheWayThere) {
  const Room room = CorridorOfEqualRooms(12);
  const DriftingDrive drive = Drive(room, {{1, 1}, {47, 1}, {1, 1}}, {1.005, 0.0});
  LoopCloser closer{LoopCloserOptions()};
  const GraphPoses poses = PosesAfter(drive, &closer);
  // A pitch is 4 m: a single wrong room would show. The way is 0.5 % too long.
  EXPECT_LT(LargestError(poses, drive.truth), 0.5);
}

/// Two corridors of 44 m side by side, joined at both ends; what stands in one of them stands in
/// the other as well, 2 m further on.
Room TwinCorridors() {
  Room room = Rectangle(0, 0, 44, 5) + Rectangle(2, 2.4, 42, 2.6);
  for (const double x : {4.0, 9.0, 17.0, 23.0, 31.0, 36.0}) {
    for (const double y : {0.0, 2.0}) {
      room =
          room + Rectangle(x, y, x + 0.8, y + 0.4) + Rectangle(x + 2.0, y + 2.6, x + 2.8, y + 3.0);
    }
  }
  return room;
}

TEST(LoopCloser, TwoEqualCorridorsSideBySideStayTwo) {
  // Beyond a range of 6 m nothing tells how far the ends are.
  const DriftingDrive drive =
      Drive(TwinCorridors(), {{3, 1.2}, {43, 1.2}, {43, 3.8}, {1, 3.8}, {1, 1.2}, {43, 1.2}},
            {1.001, 0.0}, 6.0);
  LoopCloser closer{LoopCloserOptions()};
  double largest = 0.0;
  for (std::size_t i = 0; i < drive.keyframes.size(); ++i) {
    closer.Add(drive.keyframes[i]);
    const Eigen::Vector2d error =
        closer.poses().at(static_cast<int>(i)).translation() - drive.truth[i].translation();
    largest = std::max(largest, error.norm());
  }
  EXPECT_GT(closer.closures(), 0);
  EXPECT_LT(largest, 0.3);
}

TEST(LoopCloser, TakesAClosureBackThatLaterOnesContradict) {
  const DriftingDrive drive = Drive(RingOfCorridors(), TwiceAroundTheRing(), {1.0, 0.0});
  LoopCloser first{LoopCloserOptions()};
  const std::size_t begin = drive.keyframes.size() / 4;
  for (std::size_t i = 0; i < begin; ++i) first.Add(drive.keyframes[i]);
  ASSERT_EQ(first.closures(), 0);
  // The place 2 m ahead, with the trust of a good match.
  GraphMemory memory = first.memory();
  GraphConstraint wrong;
  wrong.from = 2;
  wrong.to = static_cast<int>(begin) - 3;
  wrong.from_from_to = drive.truth[wrong.from].Inverse() * drive.truth[wrong.to];
  wrong.from_from_to.x += 2.0;
  wrong.information = Eigen::Vector3d(2500, 2500, 62500).asDiagonal();
  wrong.robust = true;
  wrong.overlap = 0.5;
  memory.constraints.push_back(wrong);
  LoopCloser closer{LoopCloserOptions()};
  closer.Load(memory);
  ASSERT_EQ(closer.closures(), 1);
  const std::size_t half = 3 * drive.keyframes.size() / 4;
  for (std::size_t i = begin; i < half; ++i) closer.Add(drive.keyframes[i]);
  EXPECT_GT(closer.closures(), 10);
  for (const GraphConstraint& c : closer.constraints()) {
    EXPECT_FALSE(c.from == wrong.from && c.to == wrong.to);
  }
  // It goes on like one that has never had it.
  LoopCloser other{LoopCloserOptions()};
  other.Load(closer.memory());
  for (std::size_t i = half; i < drive.keyframes.size(); ++i) {
    closer.Add(drive.keyframes[i]);
    other.Add(drive.keyframes[i]);
  }
  EXPECT_EQ(closer.closures(), other.closures());
  EXPECT_LT(LargestError(closer.poses(), drive.truth), 0.1);
}

}  // namespace
}  // namespace scan_image_slam
