#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace scan_image_slam {

/// Load of a process since its beginning.
struct ProcessLoad {
  double cpu_seconds = 0.0;  ///< processor time of all its threads [s]
  double memory_mb = 0.0;    ///< resident now [MB]
  int threads = 0;
  int open_files = 0;  ///< also sockets
};

/// Of a process of this machine; none if there is no such process.
std::optional<ProcessLoad> ReadProcessLoad(int pid);

/// Load of a node's process since it was first looked at.
struct NodeLoad {
  int pid = 0;
  double cpu_seconds = 0.0;     ///< also that of its earlier processes, up to the last look [s]
  double memory_mb = 0.0;       ///< resident at the last look [MB]
  double peak_memory_mb = 0.0;  ///< largest of all looks [MB]
  int threads = 0;              ///< at the last look
  int open_files = 0;
};

/// Looks at the processes that publish some topics: those of the nodes or, if they are nodelets,
/// that of their manager. Nodes of other machines are left out.
class NodeLoads {
 public:
  explicit NodeLoads(std::vector<std::string> topics) : topics_(std::move(topics)) {}

  /// Asks the master who they are, which takes some milliseconds, and adds up their load.
  void Look();
  /// By the name of the node.
  const std::map<std::string, NodeLoad>& loads() const { return loads_; }

 private:
  struct Watched {
    int pid = 0;
    double cpu_seconds = 0.0;  ///< of the process at the last look
  };
  std::vector<std::string> topics_;  ///< full names
  std::map<std::string, Watched> watched_;
  std::map<std::string, NodeLoad> loads_;
};

}  // namespace scan_image_slam
