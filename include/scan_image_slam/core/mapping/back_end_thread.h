#pragma once

#include "scan_image_slam/core/mapping/back_end.h"

#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace scan_image_slam {

/// What the back-end knows after its last optimisation.
struct GraphState {
  GraphPoses poses;                           ///< of the first keyframes
  Anchors let_go;                             ///< since the news before were taken
  std::vector<std::pair<int, int>> closures;  ///< keyframes that see the same place
};

/// What the back-end has found out; the latest of each.
struct BackEndNews {
  std::optional<GraphState> graph;  ///< keyframes have moved
  std::optional<Location> location;
};

/// A BackEnd in a thread of its own, so that no scan waits for it. Work is done in the order in
/// which it is given.
class BackEndThread {
 public:
  explicit BackEndThread(const LoopCloserOptions& options, const LocalizerOptions& localizer = {});
  ~BackEndThread();
  BackEndThread(const BackEndThread&) = delete;
  BackEndThread& operator=(const BackEndThread&) = delete;

  /// See LoopCloser::SetOptions.
  void SetOptions(const LoopCloserOptions& options);

  /// Gives a keyframe. Number 0 starts a new map: what was found before is not told any more.
  void Add(std::shared_ptr<const Keyframe> keyframe);

  void Look(Sighting sighting);

  /// Starts with another map, as number 0 does.
  void Load(GraphMemory graph);

  /// Writes a state, its graph being that of all keyframes given so far. The future holds why the
  /// file could not be written; nothing if it was. It is broken once work has failed (see Take).
  std::future<std::string> Save(MapState state, std::string path);

  /// What was found since the last call. Throws what the work has thrown: there is no memory left.
  BackEndNews Take();

  /// Keyframes, sightings and files that wait.
  int waiting() const;

 private:
  using Work = std::function<BackEndNews(BackEnd&)>;
  struct Job {
    Work work;
    int map_number = 0;
    int taken = -1;  ///< latest keyframe of the news that had been taken
  };
  void Post(Work work, bool new_map);
  void Run();

  BackEnd back_end_;  ///< of the thread alone
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Job> jobs_;
  BackEndNews news_;
  std::exception_ptr failure_;
  int map_number_ = 0;
  int taken_ = -1;  ///< latest keyframe of the news that were taken
  bool stop_ = false;
  std::thread thread_;
};

}  // namespace scan_image_slam
