#include "scan_image_slam/core/mapping/atomic_file.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace scan_image_slam {
namespace {

[[noreturn]] void Fail(const std::string& what, const std::string& path) {
  throw std::runtime_error(what + " " + path + ": " + std::strerror(errno));
}

/// Closes a file, and removes it unless it has taken its place.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& beside) : path_(beside + ".XXXXXX") {
    file_ = mkstemp(path_.data());
    if (file_ < 0) Fail("can't write", path_);
  }
  ~TemporaryFile() {
    if (file_ >= 0) close(file_);
    if (!path_.empty()) unlink(path_.c_str());
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  void Write(const std::string& content) const {
    for (std::size_t done = 0; done < content.size();) {
      const ssize_t written = write(file_, content.data() + done, content.size() - done);
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) Fail("can't write", path_);
      done += static_cast<std::size_t>(written);
    }
    constexpr mode_t kForAllToRead = 0644;
    if (fchmod(file_, kForAllToRead) != 0 || fsync(file_) != 0) Fail("can't write", path_);
  }

  void TakePlaceOf(const std::string& path) {
    if (rename(path_.c_str(), path.c_str()) != 0) Fail("can't replace", path);
    path_.clear();
  }

 private:
  std::string path_;
  int file_ = -1;
};

/// So that the new name is on the disk, too. Not all file systems can; then nothing is lost.
void SyncFolder(const std::string& path) {
  const int folder = open(path.c_str(), O_RDONLY | O_DIRECTORY);
  if (folder < 0) return;
  fsync(folder);
  close(folder);
}

}  // namespace

void ReplaceFile(const std::string& path, const std::string& content) {
  const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw std::runtime_error("can't make " + folder.string() + ": " + error.message());
  TemporaryFile file(path);
  file.Write(content);
  file.TakePlaceOf(path);
  SyncFolder(folder.string());
}

std::string ReadWholeFile(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    throw std::runtime_error("can't read " + path + ": it is a folder");
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) Fail("can't read", path);
  std::string content((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  if (file.bad()) Fail("can't read", path);
  return content;
}

}  // namespace scan_image_slam
