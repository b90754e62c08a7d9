#include "scan_image_slam/ros/master_watch.h"

#include <XmlRpcClient.h>
#include <ros/init.h>
#include <ros/master.h>
#include <ros/this_node.h>
#include <ros/xmlrpc_manager.h>

namespace scan_image_slam {
namespace {

constexpr double kPeriod = 2.0;  // [s]

enum class Answer { kNone, kKnown, kUnknown };

/// ros::master::execute does not tell an unknown node from a master that is not there.
Answer LookUpThisNode() {
  const ros::XMLRPCManagerPtr& manager = ros::XMLRPCManager::instance();
  XmlRpc::XmlRpcClient* client = manager->getXMLRPCClient(
      ros::master::getHost(), static_cast<int>(ros::master::getPort()), "/");
  if (client == nullptr) return Answer::kNone;
  XmlRpc::XmlRpcValue request;
  request[0] = ros::this_node::getName();
  request[1] = ros::this_node::getName();
  XmlRpc::XmlRpcValue response;  // of code, message and address
  const bool answered = client->execute("lookupNode", request, response) && !client->isFault();
  manager->releaseXMLRPCClient(client);
  if (!answered || response.getType() != XmlRpc::XmlRpcValue::TypeArray || response.size() != 3 ||
      response[0].getType() != XmlRpc::XmlRpcValue::TypeInt) {
    return Answer::kNone;
  }
  return static_cast<int>(response[0]) == 1 ? Answer::kKnown : Answer::kUnknown;
}

std::string Describe(Answer answer) {
  switch (answer) {
    case Answer::kKnown:
      return "";
    case Answer::kNone:
      return ros::master::getURI() +
             " does not answer: what is connected goes on, but nobody new finds topics and "
             "services";
    case Answer::kUnknown:
      break;
  }
  return ros::master::getURI() +
         " was started anew and does not know this node: what is connected goes on, but nobody new "
         "finds its topics and services. Restart the launch";
}

}  // namespace

MasterWatch::MasterWatch(ros::NodeHandle node) : spinner_(1, &queue_) {
  node.setCallbackQueue(&queue_);
  timer_ = node.createWallTimer(ros::WallDuration(kPeriod),
                                [this](const ros::WallTimerEvent&) { Ask(); });
  spinner_.start();
}

MasterWatch::~MasterWatch() { spinner_.stop(); }

std::string MasterWatch::Problem() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return problem_;
}

void MasterWatch::Ask() {
  const std::string problem = Describe(LookUpThisNode());
  if (ros::isShuttingDown()) return;  // a node that takes its leave is unknown, too
  const std::lock_guard<std::mutex> lock(mutex_);
  problem_ = problem;
}

}  // namespace scan_image_slam
