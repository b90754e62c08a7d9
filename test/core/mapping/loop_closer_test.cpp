#include "scan_image_slam/core/mapping/loop_closer.h"

#include "loop_fixtures.h"
#include "scan_image_slam/core/mapping/loop_closing_thread.h"

#include <chrono>
#include <cstring>
#include <thread>

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

TEST(LoopClosingThread, FindsWhatTheCloserFinds) {
  const DriftingDrive drive = Drive(RingOfCorridors(), TwiceAroundTheRing(), {1.005, 0.0005});
  LoopCloser closer{LoopCloserOptions()};
  const std::vector<Pose2> expected = PosesAfter(drive, &closer);
  LoopClosingThread thread{LoopCloserOptions()};
  for (const auto& keyframe : drive.keyframes) thread.Add(keyframe);
  std::vector<Pose2> found;
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(2);
  while (found.size() < expected.size() && std::chrono::steady_clock::now() < deadline) {
    if (const auto state = thread.Take()) found = state->poses;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  ASSERT_EQ(found.size(), expected.size());
  EXPECT_EQ(std::memcmp(found.data(), expected.data(), found.size() * sizeof(Pose2)), 0);
}

TEST(LoopClosingThread, EndsWhileKeyframesWait) {
  const DriftingDrive drive = Drive(RingOfCorridors(), TwiceAroundTheRing(), {1.005, 0.0005});
  LoopClosingThread thread{LoopCloserOptions()};
  for (const auto& keyframe : drive.keyframes) thread.Add(keyframe);
}

TEST(LoopClosingThread, ANewMapDropsWhatWasFoundInTheOld) {
  const DriftingDrive drive = Drive(RingOfCorridors(), TwiceAroundTheRing(), {1.005, 0.0005});
  LoopClosingThread thread{LoopCloserOptions()};
  for (const auto& keyframe : drive.keyframes) thread.Add(keyframe);
  thread.Add(drive.keyframes.front());
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(2);
  while (thread.waiting() > 0 && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_EQ(thread.waiting(), 0);
  EXPECT_FALSE(thread.Take().has_value());
}

}  // namespace
}  // namespace scan_image_slam
