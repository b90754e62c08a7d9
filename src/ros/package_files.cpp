#include "scan_image_slam/ros/package_files.h"

#include "scan_image_slam/core/recording/number_text.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <vector>

namespace scan_image_slam {

std::string PackageFile(const std::string& relative) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  // <prefix>/lib/scan_image_slam/<program>
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  const fs::path installed =
      program.parent_path().parent_path().parent_path() / "share" / "scan_image_slam" / relative;
  const fs::path source = fs::path(SCAN_IMAGE_SLAM_SOURCE_DIR) / relative;
  for (const fs::path& path : {installed, source}) {
    if (fs::is_regular_file(path, ignored)) return path.string();
  }
  throw std::runtime_error("the package's file " + relative + " is neither at " +
                           installed.string() + " nor at " + source.string());
}

std::string FindWorld(const std::string& world) {
  std::error_code ignored;
  if (std::filesystem::is_regular_file(world, ignored)) return world;
  if (world.find('/') != std::string::npos) throw std::runtime_error(world + " does not exist");
  const std::filesystem::path folder =
      std::filesystem::path(PackageFile("config/worlds/laboratory.yaml")).parent_path();
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::filesystem::path& path = entry.path();
    if (path.extension() != ".yaml") continue;
    if (path.stem() == world || path.filename() == world) return path.string();
    names.push_back(path.stem().string());
  }
  std::sort(names.begin(), names.end());
  throw std::runtime_error("there is no world " + world + "; there are " + ListText(names) +
                           ", or give the path of a file");
}

}  // namespace scan_image_slam
