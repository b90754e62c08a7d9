#include "scan_image_slam/core/mapping/loop_closer.h"

#include "loop_fixtures.h"

#include <cstring>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

std::vector<Pose2> PosesAfter(const DriftingDrive& drive, LoopCloser* closer) {
  for (const auto& keyframe : drive.keyframes) closer->Add(keyframe);
  return closer->poses();
}

TEST(LoopCloser, ASecondRoundTakesTheDriftAway) {
  const DriftingDrive drive = Drive(RingOfCorridors(), TwiceAroundTheRing(), {1.005, 0.0005});
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
  const std::vector<Pose2> poses = PosesAfter(drive, &with);
  EXPECT_GT(with.closures(), 10);
  // What is left is the bend of the first round, which nothing contradicts at its far side.
  EXPECT_LT(LargestError(poses, drive.truth), 0.3 * drifted);
  EXPECT_LT((poses.back().translation() - drive.truth.back().translation()).norm(), 0.05);
}

TEST(LoopCloser, TheSameKeyframesGiveTheSameBits) {
  const DriftingDrive drive = Drive(RingOfCorridors(), TwiceAroundTheRing(), {1.005, 0.0005});
  LoopCloser first{LoopCloserOptions()};
  LoopCloser second{LoopCloserOptions()};
  const std::vector<Pose2> a = PosesAfter(drive, &first);
  const std::vector<Pose2> b = PosesAfter(drive, &second);
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(Pose2)), 0);
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
  ASSERT_EQ(second.poses().size(), whole.poses().size());
  EXPECT_EQ(std::memcmp(second.poses().data(), whole.poses().data(),
                        whole.poses().size() * sizeof(Pose2)),
            0);
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
  const std::vector<Pose2> poses = PosesAfter(drive, &closer);
  EXPECT_EQ(closer.closures(), 0);
}

TEST(LoopCloser, EqualRoomsOnTheWayBackAreThoseOfTheWayThere) {
  const Room room = CorridorOfEqualRooms(12);
  const DriftingDrive drive = Drive(room, {{1, 1}, {47, 1}, {1, 1}}, {1.005, 0.0});
  LoopCloser closer{LoopCloserOptions()};
  const std::vector<Pose2> poses = PosesAfter(drive, &closer);
  // A pitch is 4 m: a single wrong room would show. The way is 0.5 % too long.
  EXPECT_LT(LargestError(poses, drive.truth), 0.5);
}

}  // namespace
}  // namespace scan_image_slam
