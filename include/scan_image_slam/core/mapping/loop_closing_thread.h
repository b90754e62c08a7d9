#pragma once

#include "scan_image_slam/core/mapping/loop_closer.h"

#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

namespace scan_image_slam {

/// What the back-end knows after its last optimisation.
struct GraphState {
  std::vector<Pose2> poses;                   ///< map_from_base of the first keyframes
  std::vector<std::pair<int, int>> closures;  ///< keyframes that see the same place
};

/// A LoopCloser in a thread of its own, so that no scan waits for it.
class LoopClosingThread {
 public:
  explicit LoopClosingThread(const LoopCloserOptions& options);
  ~LoopClosingThread();
  LoopClosingThread(const LoopClosingThread&) = delete;
  LoopClosingThread& operator=(const LoopClosingThread&) = delete;

  /// See LoopCloser::SetOptions.
  void SetOptions(const LoopCloserOptions& options);

  /// Queues a keyframe. Number 0 starts a new map: what is queued or found is dropped.
  void Add(std::shared_ptr<const Keyframe> keyframe);

  /// What was found since the last call, if keyframes have moved.
  std::optional<GraphState> Take();

  /// Keyframes that wait to be looked at.
  int waiting() const;

 private:
  void Run();

  LoopCloser closer_;  ///< of the thread alone
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::shared_ptr<const Keyframe>> queue_;
  std::optional<GraphState> found_;
  std::optional<LoopCloserOptions> new_options_;
  int map_number_ = 0;
  bool stop_ = false;
  std::thread thread_;
};

}  // namespace scan_image_slam
