#include "scan_image_slam/ros/side_thread.h"

#include <chrono>
#include <cstdint>
#include <future>
#include <memory>
#include <stdexcept>
#include <utility>

#include <boost/make_shared.hpp>

namespace scan_image_slam {
namespace {

constexpr char kEnds[] = "the node is being shut down";

/// Some work in the queue of a node's callbacks.
class QueuedWork : public ros::CallbackInterface {
 public:
  explicit QueuedWork(std::packaged_task<void()> work) : work_(std::move(work)) {}
  CallResult call() override {
    work_();
    return Success;
  }

 private:
  std::packaged_task<void()> work_;
};

}  // namespace

SideThread::SideThread(const ros::NodeHandle& node) : node_(node) { spinner_.start(); }

SideThread::~SideThread() {
  ends_ = true;
  for (ros::ServiceServer& service : services_) service.shutdown();
  spinner_.stop();
}

void SideThread::InNodeThread(const std::function<void()>& work) {
  constexpr std::chrono::milliseconds kPatience(20);
  std::packaged_task<void()> task(work);
  std::future<void> done = task.get_future();
  ros::CallbackQueueInterface* const queue = node_.getCallbackQueue();
  const auto id = reinterpret_cast<std::uintptr_t>(this);
  queue->addCallback(boost::make_shared<QueuedWork>(std::move(task)), id);
  while (done.wait_for(kPatience) != std::future_status::ready) {
    if (!ends_) continue;
    queue->removeByID(id);  // so that it never runs when what it uses is gone
    throw std::runtime_error(kEnds);
  }
  try {
    done.get();
  } catch (const std::future_error&) {  // the queue was thrown away, and the work with it
    throw std::runtime_error(kEnds);
  }
}

}  // namespace scan_image_slam
