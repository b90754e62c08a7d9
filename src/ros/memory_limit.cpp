#include "scan_image_slam/ros/memory_limit.h"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <system_error>

#include <sys/resource.h>
#include <unistd.h>

namespace scan_image_slam {
namespace {

constexpr std::size_t kLeast = std::size_t{2} << 30;

/// Private, writable memory, as RLIMIT_DATA counts it. [pages]
std::size_t PagesOfData() {
  std::ifstream file("/proc/self/statm");
  std::size_t pages = 0;
  for (int field = 1; field <= 6; ++field) file >> pages;
  if (!file) throw std::system_error(EIO, std::generic_category(), "/proc/self/statm");
  return pages;
}

}  // namespace

std::size_t LimitMemory() {
  const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  const std::size_t quarter = static_cast<std::size_t>(sysconf(_SC_PHYS_PAGES)) / 4 * page;
  rlimit limit{};
  getrlimit(RLIMIT_DATA, &limit);
  limit.rlim_cur =
      std::min<rlim_t>(limit.rlim_cur, PagesOfData() * page + std::max(quarter, kLeast));
  if (setrlimit(RLIMIT_DATA, &limit) != 0) {
    throw std::system_error(errno, std::generic_category(), "setrlimit(RLIMIT_DATA)");
  }
  return limit.rlim_cur;
}

}  // namespace scan_image_slam
