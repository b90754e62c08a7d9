// Measures the running nodes as a user sees them: how long after a scan its pose comes, which scans
// get none, and what the processes of the nodes cost.

#include "latency_report.h"
#include "node_load.h"
#include "run_tool.h"
#include "scan_image_slam/core/evaluation/latency_record.h"
#include "scan_image_slam/core/mapping/atomic_file.h"
#include "scan_image_slam/core/recording/number_text.h"
#include "scan_image_slam/ros/sensor_conversions.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <mutex>
#include <stdexcept>
#include <thread>

#include <CLI/CLI.hpp>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <sensor_msgs/LaserScan.h>

namespace scan_image_slam {
namespace {

struct Arguments {
  std::string scan_topic = "scan";
  std::string pose_topic = "pose";
  double duration = 0.0;
  double period = 10.0;
  double wait = 10.0;
  std::string json;
};

double Now() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double>(now).count();
}

/// Sleeps until `done` or until a time of Now(); false if that came first, or the end of the
/// program.
template <typename Done>
bool WaitUntil(double end, const Done& done) {
  while (!done()) {
    if (Now() >= end || !ros::ok()) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return true;
}

/// Receives scans and poses in a thread of its own.
class Receiver {
 public:
  explicit Receiver(const Arguments& arguments) : spinner_(1, &queue_) {
    constexpr std::uint32_t kQueue = 1000;
    const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
    node_.setCallbackQueue(&queue_);
    scans_ = node_.subscribe(arguments.scan_topic, kQueue, &Receiver::OnScan, this, hints);
    poses_ = node_.subscribe(arguments.pose_topic, kQueue, &Receiver::OnPose, this, hints);
    spinner_.start();
  }

  LatencyRecord record() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return record_;
  }
  void Close() {
    const std::lock_guard<std::mutex> lock(mutex_);
    record_.Close();
  }
  bool begun() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return record_.begun();
  }
  OddPoses odd() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return {record_.strangers(), not_finite_};
  }
  bool has_scan() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return has_scan_;
  }
  std::string scan_topic() const { return scans_.getTopic(); }
  std::string pose_topic() const { return poses_.getTopic(); }

 private:
  void OnScan(const sensor_msgs::LaserScanConstPtr& message) {
    const Stamp now = FromSeconds(Now());
    const std::lock_guard<std::mutex> lock(mutex_);
    has_scan_ = true;
    record_.AddScan(static_cast<Stamp>(message->header.stamp.toNSec()), now);
  }
  void OnPose(const geometry_msgs::PoseWithCovarianceStampedConstPtr& message) {
    const Stamp now = FromSeconds(Now());
    const geometry_msgs::Pose& pose = message->pose.pose;
    const bool finite =
        std::isfinite(pose.position.x + pose.position.y + pose.orientation.z + pose.orientation.w);
    const std::lock_guard<std::mutex> lock(mutex_);
    not_finite_ += finite ? 0 : 1;
    record_.AddPose(static_cast<Stamp>(message->header.stamp.toNSec()), now);
  }

  mutable std::mutex mutex_;
  LatencyRecord record_;
  bool has_scan_ = false;
  std::size_t not_finite_ = 0;
  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  ros::Subscriber scans_;
  ros::Subscriber poses_;
  ros::AsyncSpinner spinner_;
};

/// Waits for the first pose. Throws std::runtime_error, naming the topic, if none comes.
void AwaitPose(const Receiver& receiver, double wait) {
  if (WaitUntil(Now() + wait, [&] { return receiver.begun(); })) return;
  const std::string seconds = NumberText(wait, 3) + " s";
  if (!receiver.has_scan()) {
    throw std::runtime_error("no scan came on " + receiver.scan_topic() + " within " + seconds +
                             ": start the laser's driver or the bag, or name its topic by "
                             "--scan-topic");
  }
  throw std::runtime_error("scans come on " + receiver.scan_topic() + ", but within " + seconds +
                           " none of them had a pose on " + receiver.pose_topic() +
                           ": start the nodes, look at their diagnostics, or name the topic by "
                           "--pose-topic");
}

/// What has been seen since the first pose.
LatencyPeriod Total(const LatencyRecord& record, const NodeLoads& nodes, double seconds) {
  return {seconds, record.latencies().size() + record.dropped(), record.dropped(),
          record.latencies(), nodes.loads()};
}

/// What `total` has more than the total before it.
LatencyPeriod Since(const LatencyPeriod& before, const LatencyPeriod& total) {
  LatencyPeriod period = total;
  period.seconds -= before.seconds;
  period.scans -= before.scans;
  period.dropped -= before.dropped;
  period.latencies.erase(
      period.latencies.begin(),
      period.latencies.begin() + static_cast<std::ptrdiff_t>(before.latencies.size()));
  for (auto& [name, load] : period.loads) {
    const auto earlier = before.loads.find(name);
    if (earlier != before.loads.end()) load.cpu_seconds -= earlier->second.cpu_seconds;
  }
  return period;
}

/// Looks at the processes and the record every period, and keeps what it saw.
class Measurement {
 public:
  Measurement(const Receiver& receiver, std::string json)
      : receiver_(receiver),
        json_(std::move(json)),
        nodes_({ros::names::resolve("icp_model"), ros::names::resolve("scan_match"),
                receiver.pose_topic()}) {
    nodes_.Look();
    before_ = Total(receiver_.record(), nodes_, 0.0);
    total_ = before_;
  }

  double begin() const { return begin_; }

  void Look() {
    nodes_.Look();
    const LatencyRecord record = receiver_.record();
    const LatencyPeriod total = Total(record, nodes_, Now() - begin_);
    periods_.push_back(Since(total_, total));
    total_ = total;
    Write(Since(before_, total_), receiver_.odd());
  }

  /// Writes and prints all. Scans that still wait for their pose count as dropped.
  void Finish() {
    const LatencyRecord record = receiver_.record();
    LatencyPeriod whole = Since(before_, Total(record, nodes_, total_.seconds));
    whole.scans += record.waiting();
    whole.dropped += record.waiting();
    Write(whole, receiver_.odd());
    std::cout << ReportText(whole, receiver_.odd());
  }

 private:
  void Write(const LatencyPeriod& whole, const OddPoses& odd) const {
    if (!json_.empty()) ReplaceFile(json_, ReportJson(whole, odd, periods_).dump(2) + "\n");
  }

  const Receiver& receiver_;
  std::string json_;
  NodeLoads nodes_;
  double begin_ = Now();
  LatencyPeriod before_;  ///< what was seen when it began
  LatencyPeriod total_;   ///< at the last look
  std::vector<LatencyPeriod> periods_;
};

void Measure(const Arguments& arguments) {
  if (!ros::master::check()) {
    throw std::runtime_error("no master answers at " + ros::master::getURI() +
                             ": start the nodes first, or set ROS_MASTER_URI");
  }
  Receiver receiver(arguments);
  AwaitPose(receiver, arguments.wait);
  Measurement measurement(receiver, arguments.json);
  std::cerr << "measuring; Ctrl-C ends it\n";
  const double end = arguments.duration > 0.0 ? measurement.begin() + arguments.duration : HUGE_VAL;
  while (ros::ok() && Now() < end) {
    WaitUntil(std::min(Now() + arguments.period, end), [] { return false; });
    measurement.Look();
  }
  receiver.Close();
  // Scans that are on their way are not dropped yet; a pose later than this is of no use.
  constexpr double kLate = 1.0;
  WaitUntil(Now() + kLate, [&] { return receiver.record().waiting() == 0; });
  measurement.Finish();
}

int Main(int argc, char** argv) {
  std::vector<std::string> words;
  ros::removeROSArgs(argc, argv, words);
  std::vector<char*> own;
  own.reserve(words.size());
  for (std::string& word : words) own.push_back(word.data());
  Arguments arguments;
  CLI::App app(
      "Measures running nodes: time from each scan to its pose, scans without a pose, "
      "processor time and memory of the nodes. Needs the master; remappings as for nodes.");
  app.add_option("--duration", arguments.duration, "[s]; without it, until it is stopped")
      ->check(CLI::Range(0.1, 1e9));
  app.add_option("--json", arguments.json,
                 "file for the same in JSON and that of each period, written every period");
  app.add_option("--period", arguments.period, "between two looks at the processes [s]")
      ->check(CLI::Range(0.1, 3600.0))
      ->capture_default_str();
  app.add_option("--wait", arguments.wait, "longest wait for the first pose [s]")
      ->check(CLI::Range(0.1, 1e9))
      ->capture_default_str();
  app.add_option("--scan-topic", arguments.scan_topic)->capture_default_str();
  app.add_option("--pose-topic", arguments.pose_topic)->capture_default_str();
  return RunTool(
      &app, static_cast<int>(own.size()), own.data(), "measure_latency", [] {},
      [&] {
        ros::init(argc, argv, "measure_latency", ros::init_options::AnonymousName);
        Measure(arguments);
      });
}

}  // namespace
}  // namespace scan_image_slam

int main(int argc, char** argv) { return scan_image_slam::Main(argc, argv); }
