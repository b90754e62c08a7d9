#include "scan_image_slam/ros/package_files.h"

#include <filesystem>
#include <stdexcept>

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
  const bool has_ending = std::filesystem::path(world).extension() == ".yaml";
  return PackageFile("config/worlds/" + world + (has_ending ? "" : ".yaml"));
}

}  // namespace scan_image_slam
