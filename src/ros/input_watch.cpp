#include "scan_image_slam/ros/input_watch.h"

#include "scan_image_slam/core/recording/number_text.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

#include <ros/console.h>

namespace scan_image_slam {
namespace {

constexpr double kTellPeriod = 5.0;      // [s]
constexpr double kFirstTell = 2.5;       // so that a missing input is named within five seconds [s]
constexpr double kLookPeriod = 0.5;      // [s]
constexpr double kDiagnosePeriod = 1.0;  // [s]
constexpr double kSilence = 2.0;         // after which a topic counts as gone [s]
constexpr double kMaxWait = 0.2;         // of a message for its turn [s]
constexpr double kMaxClockOffset = 0.1;  // of a topic against another [s]
constexpr double kMaxAge = 1.0;  // of stamps by the clock of this machine, or their lead [s]

std::string WithoutNumbers(const std::string& text) {
  std::string rest;
  for (const char c : text) {
    if (std::isdigit(static_cast<unsigned char>(c)) == 0) rest += c;
  }
  return rest;
}

}  // namespace

InputWatch::InputWatch(ros::NodeHandle node, ros::NodeHandle private_node)
    : updater_(node, private_node, private_node.getNamespace()),
      master_watch_(node),
      begin_(ros::WallTime::now()) {
  updater_.setHardwareID("none");
  updater_.add("inputs", this, &InputWatch::Diagnose);
  tell_timer_ = node.createWallTimer(ros::WallDuration(kLookPeriod), &InputWatch::Tell, this);
  diagnose_timer_ =
      node.createWallTimer(ros::WallDuration(kDiagnosePeriod),
                           [this](const ros::WallTimerEvent&) { updater_.force_update(); });
}

void InputWatch::Expect(const ros::Subscriber& subscriber, const std::string& type, bool optional) {
  Expect(
      subscriber.getTopic(), [subscriber] { return subscriber.getNumPublishers(); }, type,
      optional);
}

void InputWatch::Expect(const std::string& topic, std::function<std::uint32_t()> publishers,
                        const std::string& type, bool optional) {
  Topic& t = topics_[topic];
  t = Topic();
  t.publishers = std::move(publishers);
  t.type = type;
  t.optional = optional;
}

void InputWatch::Arrived(const std::string& topic, std::uint64_t measured, std::uint32_t seq) {
  constexpr std::uint32_t kMostLost = 100000;  // more: it is another publisher's number
  Topic& t = topics_[topic];
  ++t.messages;
  t.last = ros::WallTime::now();
  const auto now = static_cast<double>(ros::Time::now().toNSec());
  if (measured != 0 && now > 0.0) {  // simulated time has begun
    const double delay = 1e-9 * (now - static_cast<double>(measured));
    t.delay = std::min(t.delay.value_or(delay), delay);
  }
  if (t.last_seq != 0 && seq > t.last_seq + 1 && seq - t.last_seq < kMostLost) {
    t.lost += seq - t.last_seq - 1;
    t.last_lost = t.last;
  }
  t.last_seq = seq;
}

bool InputWatch::InTime(const std::string& topic, const ros::Time& received) {
  if ((ros::Time::now() - received).toSec() <= kMaxWait) return true;
  Topic& t = topics_[topic];
  ++t.left_out;
  t.last_left_out = ros::WallTime::now();
  return false;
}

void InputWatch::SetProblem(const std::string& key, const std::string& text) {
  const auto known = problems_.find(key);
  if (text.empty()) {
    if (known == problems_.end()) return;
    ROS_INFO_STREAM(key << ": all right now");
    problems_.erase(known);
    return;
  }
  if (known == problems_.end()) ROS_WARN_STREAM(key << ": " << text);
  problems_[key] = text;
}

void InputWatch::Refuse(const std::string& topic, const std::string& reason) {
  constexpr std::size_t kMaxReasons = 100;
  const std::string text = topic + ": " + reason;
  const std::string key = topic + ": " + WithoutNumbers(reason);  // others in every message
  if (refused_.size() >= kMaxReasons && refused_.count(key) == 0) refused_.clear();
  Refusal& refusal = refused_[key];
  refusal.text = text;
  ++refusal.messages;
  const ros::WallTime now = ros::WallTime::now();
  refusal.last = now;
  if ((now - refusal.told).toSec() < kTellPeriod) return;
  refusal.told = now;
  ROS_WARN_STREAM(topic << ": a message was not used: " << reason);
}

void InputWatch::AddValue(const std::string& key, std::function<std::string()> value) {
  values_[key] = std::move(value);
}

std::string InputWatch::Heading(const std::string& name, const Topic& topic) {
  return "topic " + name + " (" + topic.type + "): ";
}

std::string InputWatch::DescribeTopic(const std::string& name, const Topic& topic) {
  const std::uint32_t publishers = topic.publishers();
  const std::string what = Heading(name, topic);
  if (topic.messages == 0) {
    return what + (publishers == 0 ? "nobody publishes it; check the name, or remap it"
                                   : "it has a publisher, but no message has come");
  }
  return what + "no message for " +
         std::to_string(static_cast<int>((ros::WallTime::now() - topic.last).toSec())) + " s";
}

std::string InputWatch::DescribeCrowd(const std::string& name, const Topic& topic) {
  const std::uint32_t publishers = topic.publishers();
  if (publishers < 2) return "";
  return Heading(name, topic) + std::to_string(publishers) +
         " nodes publish it, and only one can be right; rostopic info " + name + " names them";
}

/// Messages that were lost, or left out, not long ago.
std::string InputWatch::DescribeLoss(const std::string& name, const Topic& topic) {
  const ros::WallTime lately = ros::WallTime::now() - ros::WallDuration(kTellPeriod);
  const std::string what = Heading(name, topic);
  if (topic.left_out > 0 && topic.last_left_out > lately) {
    return what + std::to_string(topic.left_out) +
           " messages were left out, as newer ones were waiting: the machine is too slow for them; "
           "free it from other work, or play the bag slower";
  }
  if (topic.lost > 0 && topic.last_lost > lately) {
    return what + std::to_string(topic.lost) +
           " messages were lost on their way, the oldest first: the machine or the network is too "
           "slow for them; free it from other work, or use nodelets";
  }
  return "";
}

/// `offset` > 0: the stamps are older than those of the topic `main` [s].
std::string InputWatch::DescribeClock(double offset, const std::string& main) {
  return "its messages come with stamps that are " + NumberText(std::abs(offset), 2) +
         (offset > 0.0 ? " s older" : " s newer") + " than those of " + main +
         ": the clocks of their machines differ (chrony mends that), or they are held up on their "
         "way";
}

/// `age`: of stamps by the clock of this machine [s]. Transforms are stamped by it, so that other
/// programs find none at stamps of another time.
std::string InputWatch::DescribeAge(double age) {
  constexpr double kRecorded = 60.0;  // [s]
  const std::string text = "its stamps are " + NumberText(std::abs(age), 1) + " s " +
                           (age > 0.0 ? "older" : "newer") + " than the time here: ";
  if (age > kRecorded && !ros::Time::isSimTime()) {
    return text +
           "is a bag played? Then set use_sim_time to true before the nodes are started, and play "
           "it with --clock";
  }
  return text + "the clocks of the machines differ (chrony mends that)";
}

/// Whether the stamps of all topics are of one clock, by those that came since the last look.
void InputWatch::CompareClocks() {
  constexpr int kSure = 2;  // looks; one may fall on a moment at which the clock was set
  const auto main = std::find_if(topics_.begin(), topics_.end(),
                                 [](const auto& entry) { return !entry.second.optional; });
  if (main == topics_.end()) return;
  const std::optional<double> main_delay = main->second.delay;
  for (auto& [name, topic] : topics_) {
    const std::optional<double> delay = std::exchange(topic.delay, std::nullopt);
    if (!delay || !main_delay) continue;
    const bool is_main = name == main->first;
    const double offset = is_main ? *delay : *delay - *main_delay;
    const std::string key = "clock of " + name;
    if (std::abs(offset) <= (is_main ? kMaxAge : kMaxClockOffset)) {
      topic.odd_clock = 0;
      SetProblem(key, "");
    } else if (++topic.odd_clock >= kSure) {
      SetProblem(key, is_main ? DescribeAge(offset) : DescribeClock(offset, main->first));
    }
  }
}

void InputWatch::Tell(const ros::WallTimerEvent& event) {
  SetProblem("master", master_watch_.Problem());
  const double age = (event.current_real - begin_).toSec();
  if (age < kFirstTell) return;
  begin_ = event.current_real - ros::WallDuration(kFirstTell - kTellPeriod);
  if (ros::Time::isSimTime() && ros::Time::now().isZero()) {
    ROS_WARN("use_sim_time is set, but nothing publishes /clock (rosbag play --clock does)");
  }
  for (const auto& [name, topic] : topics_) {
    const std::string crowd = DescribeCrowd(name, topic);
    if (!crowd.empty()) ROS_WARN_STREAM(crowd);
    const std::string loss = DescribeLoss(name, topic);
    if (!loss.empty()) ROS_WARN_STREAM(loss);
    if (topic.messages > 0 && (event.current_real - topic.last).toSec() < kSilence) continue;
    const std::string text = "waiting for " + DescribeTopic(name, topic);
    if (topic.optional) {
      ROS_INFO_STREAM(text << " (optional)");
    } else {
      ROS_WARN_STREAM(text);
    }
  }
  for (const auto& [key, text] : problems_) ROS_WARN_STREAM(key << ": " << text);
}

void InputWatch::Diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  status.summary(DiagnosticStatus::OK, "working");
  const ros::WallTime now = ros::WallTime::now();
  const double period = diagnosed_.isZero() ? 0.0 : (now - diagnosed_).toSec();
  diagnosed_ = now;
  for (auto& [name, topic] : topics_) {
    const bool alive = topic.messages > 0 && (now - topic.last).toSec() < kSilence;
    status.add(name + " messages", topic.messages);
    if (period > 0.0) {
      status.addf(name + " rate [Hz]", "%.1f", (topic.messages - topic.diagnosed) / period);
    }
    topic.diagnosed = topic.messages;
    status.add(name + " lost", topic.lost);
    status.add(name + " left out", topic.left_out);
    if (topic.delay) status.addf(name + " stamp to arrival [ms]", "%.0f", 1e3 * *topic.delay);
    for (const std::string& text : {DescribeCrowd(name, topic), DescribeLoss(name, topic)}) {
      if (!text.empty()) status.mergeSummary(DiagnosticStatus::WARN, text);
    }
    if (alive) continue;
    status.mergeSummary(topic.optional ? DiagnosticStatus::WARN : DiagnosticStatus::ERROR,
                        "waiting for " + DescribeTopic(name, topic));
  }
  CompareClocks();
  for (const auto& [key, text] : problems_) {
    status.mergeSummaryf(DiagnosticStatus::WARN, "%s: %s", key.c_str(), text.c_str());
  }
  for (const auto& [key, refusal] : refused_) {
    status.add("refused: " + refusal.text, refusal.messages);
    if ((now - refusal.last).toSec() < kTellPeriod) {
      status.mergeSummary(DiagnosticStatus::WARN, "a message was not used: " + refusal.text);
    }
  }
  for (const auto& [key, value] : values_) status.add(key, value());
}

}  // namespace scan_image_slam
