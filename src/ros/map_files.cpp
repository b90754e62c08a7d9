#include "scan_image_slam/ros/map_files.h"

#include <filesystem>
#include <stdexcept>

namespace scan_image_slam {

namespace fs = std::filesystem;

std::string PathFrom(const std::string& folder, const std::string& name) {
  if (name.empty()) throw std::invalid_argument("the name of the file is empty");
  if (name.find('\0') != std::string::npos) {
    throw std::invalid_argument("the name of the file holds a character zero");
  }
  try {
    return fs::weakly_canonical(fs::absolute(folder) / name).string();
  } catch (const fs::filesystem_error& error) {  // too long, or without end
    throw std::invalid_argument(error.what());
  }
}

std::string PathInside(const std::string& folder, const std::string& name) {
  const fs::path path = PathFrom(folder, name);
  const fs::path root = fs::weakly_canonical(fs::absolute(folder));
  const fs::path relative = path.lexically_relative(root);
  if (relative.empty() || *relative.begin() == ".." || relative == ".") {
    throw std::invalid_argument(path.string() + " lies outside the folder " + root.string() +
                                " (parameter map_folder of the mapper)");
  }
  return path.string();
}

}  // namespace scan_image_slam
