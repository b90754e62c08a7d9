// Any trajectory and any relations: refused, or written again they are the same.

#include "fuzz_input.h"
#include "scan_image_slam/core/evaluation/relations.h"
#include "scan_image_slam/core/evaluation/trajectory.h"

#include <sstream>
#include <stdexcept>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace scan_image_slam;
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    std::istringstream input(text);
    const Trajectory trajectory = ReadTum(input, "fuzz");
    std::stringstream written;
    WriteTum(written, trajectory);
    const Trajectory again = ReadTum(written, "again");
    Require(again.size() == trajectory.size());
    for (std::size_t i = 0; i < again.size(); ++i) Require(again[i].stamp == trajectory[i].stamp);
  } catch (const std::runtime_error&) {
  }
  try {
    std::istringstream input(text);
    ReadRelations(input, "fuzz");
  } catch (const std::runtime_error&) {
  }
  return 0;
}
