#include "scan_image_slam/core/mapping/loop_closing_thread.h"

namespace scan_image_slam {
namespace {

GraphState StateOf(const LoopCloser& closer) {
  GraphState state;
  state.poses = closer.poses();
  for (const GraphConstraint& constraint : closer.constraints()) {
    if (constraint.from + 1 != constraint.to) {
      state.closures.emplace_back(constraint.from, constraint.to);
    }
  }
  return state;
}

}  // namespace

LoopClosingThread::LoopClosingThread(const LoopCloserOptions& options)
    : closer_(options), thread_([this] { Run(); }) {}

LoopClosingThread::~LoopClosingThread() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void LoopClosingThread::SetOptions(const LoopCloserOptions& options) {
  const std::lock_guard<std::mutex> lock(mutex_);
  new_options_ = options;
}

void LoopClosingThread::Add(std::shared_ptr<const Keyframe> keyframe) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (keyframe->id == 0) {
      queue_.clear();
      found_.reset();
      ++map_number_;
    }
    queue_.push_back(std::move(keyframe));
  }
  changed_.notify_one();
}

std::optional<GraphState> LoopClosingThread::Take() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::exchange(found_, std::nullopt);
}

int LoopClosingThread::waiting() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return static_cast<int>(queue_.size());
}

void LoopClosingThread::Run() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return stop_ || !queue_.empty(); });
    if (stop_) return;
    const std::shared_ptr<const Keyframe> keyframe = queue_.front();
    queue_.pop_front();
    const int map_number = map_number_;
    const auto new_options = std::exchange(new_options_, std::nullopt);
    lock.unlock();
    if (new_options) closer_.SetOptions(*new_options);
    std::optional<GraphState> found;
    if (closer_.Add(keyframe)) found = StateOf(closer_);
    lock.lock();
    if (found && map_number == map_number_) found_ = std::move(found);
  }
}

}  // namespace scan_image_slam
