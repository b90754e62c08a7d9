#include "scan_image_slam/core/mapping/back_end_thread.h"

#include "scan_image_slam/core/mapping/state_file.h"

namespace scan_image_slam {
namespace {

GraphState StateOf(const LoopCloser& closer) {
  GraphState state;
  state.poses = closer.poses();
  state.let_go = closer.let_go();
  for (const GraphConstraint& constraint : closer.constraints()) {
    if (constraint.closes_loop()) state.closures.emplace_back(constraint.from, constraint.to);
  }
  return state;
}

}  // namespace

BackEndThread::BackEndThread(const LoopCloserOptions& options, const LocalizerOptions& localizer)
    : back_end_(options, localizer), thread_([this] { Run(); }) {}

BackEndThread::~BackEndThread() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void BackEndThread::SetOptions(const LoopCloserOptions& options) {
  Post(
      [options](BackEnd& back_end) {
        back_end.SetOptions(options);
        return BackEndNews();
      },
      false);
}

void BackEndThread::Add(std::shared_ptr<const Keyframe> keyframe) {
  const bool new_map = keyframe->id == 0;
  Post(
      [keyframe = std::move(keyframe)](BackEnd& back_end) {
        BackEndNews news;
        if (back_end.Add(keyframe)) news.graph = StateOf(back_end.loop_closer());
        return news;
      },
      new_map);
}

void BackEndThread::Look(Sighting sighting) {
  Post(
      [sighting = std::move(sighting)](BackEnd& back_end) {
        return BackEndNews{std::nullopt, back_end.Look(sighting)};
      },
      false);
}

void BackEndThread::Load(GraphMemory graph) {
  Post(
      [graph = std::move(graph)](BackEnd& back_end) {
        back_end.Load(graph);
        return BackEndNews{StateOf(back_end.loop_closer()), std::nullopt};
      },
      true);
}

std::future<std::string> BackEndThread::Save(MapState state, std::string path) {
  auto written = std::make_shared<std::promise<std::string>>();  // shared, as jobs can be copied
  std::future<std::string> future = written->get_future();
  Post(
      [state = std::move(state), path = std::move(path), written](BackEnd& back_end) mutable {
        try {
          state.graph = back_end.loop_closer().memory();
          WriteState(state, path);
          written->set_value("");
        } catch (const std::exception& error) {
          written->set_value(error.what());
        }
        return BackEndNews();
      },
      false);
  return future;
}

void BackEndThread::Post(Work work, bool new_map) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (new_map) {
      ++map_number_;
      news_ = BackEndNews();
      taken_ = -1;
    }
    jobs_.push_back({std::move(work), map_number_, taken_});
  }
  changed_.notify_one();
}

BackEndNews BackEndThread::Take() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (failure_) std::rethrow_exception(failure_);
  if (news_.graph && !news_.graph->poses.empty()) taken_ = news_.graph->poses.rbegin()->first;
  return std::exchange(news_, BackEndNews());
}

int BackEndThread::waiting() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return static_cast<int>(jobs_.size());
}

void BackEndThread::Run() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return stop_ || !jobs_.empty(); });
    if (stop_) return;
    const Job job = std::move(jobs_.front());
    jobs_.pop_front();
    if (failure_) continue;  // nothing is known of the state that the graph was left in
    lock.unlock();
    BackEndNews found;
    std::exception_ptr failure;
    try {
      back_end_.ForgetLetGo(job.taken);
      found = job.work(back_end_);
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
    if (failure) failure_ = failure;
    if (job.map_number != map_number_) continue;
    if (found.graph) news_.graph = std::move(found.graph);
    if (found.location) news_.location = found.location;
  }
}

}  // namespace scan_image_slam
