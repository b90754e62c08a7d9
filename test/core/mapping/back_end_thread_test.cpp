#include "scan_image_slam/core/mapping/back_end_thread.h"

#include "loop_fixtures.h"
#include "scan_image_slam/core/mapping/atomic_file.h"
#include "scan_image_slam/core/mapping/state_file.h"
#include "support_folder.h"

#include <chrono>
#include <future>
#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

TEST(BackEndThread, FindsWhatTheCloserFinds) {
  const DriftingDrive drive = Drive(RingOfCorridors(), TwiceAroundTheRing(), {1.005, 0.0005});
  LoopCloser closer{LoopCloserOptions()};
  for (const auto& keyframe : drive.keyframes) closer.Add(keyframe);
  const GraphPoses expected = closer.poses();
  BackEndThread thread{LoopCloserOptions()};
  for (const auto& keyframe : drive.keyframes) thread.Add(keyframe);
  GraphPoses found;
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(2);
  while (found.size() < expected.size() && std::chrono::steady_clock::now() < deadline) {
    if (const auto graph = thread.Take().graph) found = graph->poses;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  ExpectSameBits(found, expected);
}

TEST(BackEndThread, EndsWhileKeyframesWait) {
  const DriftingDrive drive = Drive(RingOfCorridors(), TwiceAroundTheRing(), {1.005, 0.0005});
  BackEndThread thread{LoopCloserOptions()};
  for (const auto& keyframe : drive.keyframes) thread.Add(keyframe);
}

TEST(BackEndThread, ANewMapDropsWhatWasFoundInTheOld) {
  const DriftingDrive drive = Drive(RingOfCorridors(), TwiceAroundTheRing(), {1.005, 0.0005});
  BackEndThread thread{LoopCloserOptions()};
  for (const auto& keyframe : drive.keyframes) thread.Add(keyframe);
  thread.Add(drive.keyframes.front());
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(2);
  while (thread.waiting() > 0 && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_EQ(thread.waiting(), 0);
  EXPECT_FALSE(thread.Take().graph.has_value());
}

TEST(BackEndThread, SavesTheGraphOfWhatCameBefore) {
  const DriftingDrive drive = Drive(RingOfCorridors(), TwiceAroundTheRing(), {1.005, 0.0005});
  LoopCloser closer{LoopCloserOptions()};
  BackEndThread thread{LoopCloserOptions()};
  for (const auto& keyframe : drive.keyframes) {
    closer.Add(keyframe);
    thread.Add(keyframe);
  }
  const TemporaryFolder folder;
  std::future<std::string> written = thread.Save(MapState(), folder.File("a.state"));
  thread.Add(drive.keyframes.front());  // another map, of which the file knows nothing
  EXPECT_EQ(written.get(), "");
  MapState expected;
  expected.graph = closer.memory();
  EXPECT_GT(expected.graph.keyframes.size(), 0U);
  EXPECT_EQ(ReadWholeFile(folder.File("a.state")), EncodeState(expected));

  EXPECT_NE(thread.Save(MapState(), folder.File("a.state/b.state")).get(), "");
}

TEST(BackEndThread, TellsWhatWasLetGoUntilItIsTaken) {
  const DriftingDrive drive = Drive(RingOfCorridors(), AroundTheRing(8), {1.002, 0.0002});
  LoopCloser closer{LoopCloserOptions()};
  BackEndThread thread{LoopCloserOptions()};
  for (const auto& keyframe : drive.keyframes) {
    closer.Add(keyframe);
    thread.Add(keyframe);
  }
  const std::size_t let_go = closer.let_go().size();
  ASSERT_GT(let_go, 100U);
  const TemporaryFolder folder;
  const auto in_file = [&] {
    EXPECT_EQ(thread.Save(MapState(), folder.File("a.state")).get(), "");
    return ReadState(folder.File("a.state")).graph.let_go.size();
  };
  EXPECT_EQ(in_file(), let_go) << "scans may hang on them";
  const auto graph = thread.Take().graph;
  ASSERT_TRUE(graph.has_value());
  EXPECT_EQ(graph->let_go.size(), let_go);
  EXPECT_EQ(in_file(), 0U);
}

}  // namespace
}  // namespace scan_image_slam
