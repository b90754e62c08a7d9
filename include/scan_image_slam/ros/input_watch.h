#pragma once

#include "scan_image_slam/ros/master_watch.h"

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <ros/wall_timer.h>

namespace scan_image_slam {

/// Watches what a node needs, the master included, and says in plain words what is missing or too
/// much: on the console every five seconds until it is mended, and in /diagnostics.
class InputWatch {
 public:
  /// /diagnostics names the node after `private_node`, with its namespace.
  InputWatch(ros::NodeHandle node, ros::NodeHandle private_node);

  /// A topic that should come. `optional`: the node works without it, with less.
  void Expect(const ros::Subscriber& subscriber, const std::string& type, bool optional);
  /// The same for subscribers of other kinds; `publishers` counts those of the topic.
  void Expect(const std::string& topic, std::function<std::uint32_t()> publishers,
              const std::string& type, bool optional);
  /// The topic need not come any more.
  void Forget(const std::string& topic) { topics_.erase(topic); }
  /// A message has come on a topic (its resolved name), of something measured at `measured` [ns],
  /// whatever the sender says; 0: it says nothing. Clocks that disagree are told by it: the topic
  /// that is not optional if its stamps are of another time than that of this machine, others if
  /// they are of another time than its.
  /// By the numbers that roscpp and rospy give to messages with a header, `seq`, those that were
  /// lost on their way are counted and told; 0: the message has no number, as between nodelets.
  void Arrived(const std::string& topic, std::uint64_t measured, std::uint32_t seq = 0);

  /// False: the message, which this process has had since `received`, has waited so long for its
  /// turn that newer ones are behind it. It should be left out, so that a node with too much to do
  /// stays up to date; that is counted and told.
  bool InTime(const std::string& topic, const ros::Time& received);

  /// A condition that keeps the node from its work; an empty text means that it is over.
  void SetProblem(const std::string& key, const std::string& text);
  /// A condition of which nothing is known any more: it is told no longer.
  void ForgetProblem(const std::string& key) { problems_.erase(key); }

  /// A message that could not be used: counted, and each reason told at most every five seconds.
  void Refuse(const std::string& topic, const std::string& reason);

  /// More to be told in /diagnostics.
  void AddValue(const std::string& key, std::function<std::string()> value);

 private:
  struct Topic {
    std::function<std::uint32_t()> publishers;
    std::string type;
    bool optional = false;
    int messages = 0;
    ros::WallTime last;
    std::uint32_t last_seq = 0;
    std::uint32_t lost = 0;  ///< messages
    ros::WallTime last_lost;
    std::uint32_t left_out = 0;  ///< messages, for want of time
    ros::WallTime last_left_out;
    int diagnosed = 0;            ///< messages, at the last diagnosis
    std::optional<double> delay;  ///< between stamp and arrival, the least since then [s]
    int odd_clock = 0;            ///< diagnoses in a row that saw another clock than the scans'
  };
  void Tell(const ros::WallTimerEvent&);
  static std::string Heading(const std::string& name, const Topic& topic);
  static std::string DescribeTopic(const std::string& name, const Topic& topic);
  static std::string DescribeCrowd(const std::string& name, const Topic& topic);
  static std::string DescribeLoss(const std::string& name, const Topic& topic);
  static std::string DescribeAge(double age);
  static std::string DescribeClock(double offset, const std::string& main);
  void CompareClocks();
  void Diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);

  diagnostic_updater::Updater updater_;
  MasterWatch master_watch_;
  std::map<std::string, Topic> topics_;
  std::map<std::string, std::string> problems_;
  struct Refusal {
    std::string text;  ///< topic and reason of the last
    int messages = 0;
    ros::WallTime last;
    ros::WallTime told;
  };
  std::map<std::string, Refusal> refused_;  ///< by topic and reason, but for numbers
  std::map<std::string, std::function<std::string()>> values_;
  ros::WallTime begin_;
  ros::WallTime diagnosed_;
  ros::WallTimer tell_timer_;
  ros::WallTimer diagnose_timer_;
};

}  // namespace scan_image_slam
