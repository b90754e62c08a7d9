// Any world and any configuration: read, or refused with a message.

#include "fuzz_input.h"
#include "scan_image_slam/core/config/config_file.h"
#include "scan_image_slam/core/config/slam_parameters.h"
#include "scan_image_slam/core/config/yaml_section.h"
#include "scan_image_slam/core/simulation/scenario.h"

#include <sys/mman.h>
#include <unistd.h>

namespace scan_image_slam {
namespace {

/// A file in memory.
class MemoryFile {
 public:
  MemoryFile(const std::uint8_t* data, std::size_t size) : file_(memfd_create("yaml", 0)) {
    Require(file_ >= 0 && write(file_, data, size) == static_cast<ssize_t>(size));
  }
  ~MemoryFile() { close(file_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  std::string path() const { return "/proc/self/fd/" + std::to_string(file_); }

 private:
  int file_;
};

}  // namespace
}  // namespace scan_image_slam

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace scan_image_slam;
  const MemoryFile file(data, size);
  try {
    LoadScenario(file.path());
  } catch (const YamlError&) {
  }
  try {
    SlamOptions options;
    std::vector<ParameterSet> sets = options.Parameters();
    ApplyConfig(ReadConfigFile(file.path()), file.path(), &sets);
  } catch (const ParameterError&) {
  }
  return 0;
}
