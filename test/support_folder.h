#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

namespace scan_image_slam {

/// A new folder for the files of one test, removed again with all that is in it.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    path_ = (std::filesystem::temp_directory_path() / "scan_image_slam_test.XXXXXX").string();
    if (mkdtemp(path_.data()) == nullptr) throw std::runtime_error("can't make " + path_);
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::string& path() const { return path_; }
  std::string File(const std::string& name) const { return path_ + "/" + name; }

  /// Writes a file and returns its path.
  std::string Write(const std::string& name, const std::string& content) const {
    std::ofstream(File(name), std::ios::binary) << content;
    return File(name);
  }

  /// A message without the folder's name, which differs from run to run. Throws where it does not
  /// name the folder.
  std::string WithoutPath(std::string message) const {
    const std::size_t at = message.find(path_ + "/");
    if (at == std::string::npos) throw std::runtime_error("no path in: " + message);
    return message.erase(at, path_.size() + 1);
  }

 private:
  std::string path_;
};

}  // namespace scan_image_slam
