#include "node_load.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include <ros/master.h>
#include <ros/network.h>
#include <ros/this_node.h>
#include <unistd.h>
#include <xmlrpcpp/XmlRpc.h>

namespace scan_image_slam {
namespace {

/// Names of the nodes that publish one of the topics; empty if the master does not answer.
std::set<std::string> PublishersOf(const std::vector<std::string>& topics) {
  XmlRpc::XmlRpcValue request, response, state;
  request[0] = ros::this_node::getName();
  std::set<std::string> nodes;
  if (!ros::master::execute("getSystemState", request, response, state, false)) return nodes;
  XmlRpc::XmlRpcValue& publishers = state[0];
  for (int i = 0; i < publishers.size(); ++i) {
    const std::string topic = publishers[i][0];
    if (std::find(topics.begin(), topics.end(), topic) == topics.end()) continue;
    for (int k = 0; k < publishers[i][1].size(); ++k) nodes.insert(publishers[i][1][k]);
  }
  return nodes;
}

bool IsThisMachine(const std::string& host) {
  return host == ros::network::getHost() || host == "localhost" || host == "127.0.0.1";
}

/// Process of a node of this machine; none if it does not answer.
std::optional<int> ProcessOf(const std::string& node) {
  XmlRpc::XmlRpcValue request, response, uri;
  request[0] = ros::this_node::getName();
  request[1] = node;
  if (!ros::master::execute("lookupNode", request, response, uri, false)) return std::nullopt;
  std::string host;
  std::uint32_t port = 0;
  if (!ros::network::splitURI(uri, host, port) || !IsThisMachine(host)) return std::nullopt;
  XmlRpc::XmlRpcClient client(host.c_str(), static_cast<int>(port), "/");
  XmlRpc::XmlRpcValue caller, answer;
  caller[0] = ros::this_node::getName();
  const bool answered = client.execute("getPid", caller, answer) && !client.isFault() &&
                        answer.getType() == XmlRpc::XmlRpcValue::TypeArray && answer.size() == 3;
  if (!answered) return std::nullopt;
  return static_cast<int>(answer[2]);
}

int CountOpenFiles(const std::string& process_folder) {
  std::error_code ended;
  int count = 0;
  for (std::filesystem::directory_iterator file(process_folder + "/fd", ended), end;
       !ended && file != end; file.increment(ended)) {
    ++count;
  }
  return count;
}

}  // namespace

std::optional<ProcessLoad> ReadProcessLoad(int pid) {
  const std::string folder = "/proc/" + std::to_string(pid);
  std::ifstream file(folder + "/stat");
  std::string line;
  if (!std::getline(file, line)) return std::nullopt;
  // The name, in brackets, may hold anything; what follows begins with the third field of proc(5).
  std::istringstream fields(line.substr(line.rfind(')') + 1));
  std::vector<std::string> values;
  for (std::string value; fields >> value;) values.push_back(value);
  constexpr std::size_t kUserTicks = 14 - 3;
  constexpr std::size_t kSystemTicks = 15 - 3;
  constexpr std::size_t kThreads = 20 - 3;
  constexpr std::size_t kResidentPages = 24 - 3;
  if (values.size() <= kResidentPages) return std::nullopt;
  const double ticks = std::stod(values[kUserTicks]) + std::stod(values[kSystemTicks]);
  const double pages = std::stod(values[kResidentPages]);
  return ProcessLoad{ticks / static_cast<double>(sysconf(_SC_CLK_TCK)),
                     pages * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6,
                     std::stoi(values[kThreads]), CountOpenFiles(folder)};
}

void NodeLoads::Look() {
  for (const std::string& node : PublishersOf(topics_)) {
    const std::optional<int> pid = ProcessOf(node);
    if (!pid) continue;
    const bool first = watched_.find(node) == watched_.end();
    Watched& watched = watched_[node];
    // A node that was started anew has spent its time while it was looked at.
    if (watched.pid != *pid) watched.cpu_seconds = 0.0;
    watched.pid = *pid;
    if (first) watched.cpu_seconds = ReadProcessLoad(*pid).value_or(ProcessLoad()).cpu_seconds;
  }
  // Also those that the master no longer tells of.
  for (auto& [node, watched] : watched_) {
    const std::optional<ProcessLoad> process = ReadProcessLoad(watched.pid);
    if (!process) continue;
    NodeLoad& load = loads_[node];
    load.pid = watched.pid;
    load.cpu_seconds += process->cpu_seconds - watched.cpu_seconds;
    load.memory_mb = process->memory_mb;
    load.threads = process->threads;
    load.open_files = process->open_files;
    load.peak_memory_mb = std::max(load.peak_memory_mb, process->memory_mb);
    watched.cpu_seconds = process->cpu_seconds;
  }
}

}  // namespace scan_image_slam
