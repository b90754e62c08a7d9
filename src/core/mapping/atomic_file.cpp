#include "scan_image_slam/core/mapping/atomic_file.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <list>
#include <stdexcept>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace scan_image_slam {
namespace {

[[noreturn]] void Fail(const std::string& what, const std::string& path) {
  throw std::runtime_error(what + " " + path + ": " + std::strerror(errno));
}

void MakeFolder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw std::runtime_error("can't make " + folder.string() + ": " + error.message());
}

/// The new content beside a file whose place it takes in the end; removed if that does not happen.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& target)
      : target_(target),
        folder_(std::filesystem::absolute(target).parent_path()),
        path_(target + ".XXXXXX") {
    MakeFolder(folder_);
    file_ = mkstemp(path_.data());
    if (file_ < 0) Fail("can't write", target_);
  }
  ~TemporaryFile() {
    close(file_);
    if (!path_.empty()) unlink(path_.c_str());
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  void Write(const std::string& content) const {
    for (std::size_t done = 0; done < content.size();) {
      const ssize_t written = write(file_, content.data() + done, content.size() - done);
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) Fail("can't write", target_);
      done += static_cast<std::size_t>(written);
    }
    constexpr mode_t kForAllToRead = 0644;
    if (fchmod(file_, kForAllToRead) != 0 || fsync(file_) != 0) Fail("can't write", target_);
  }

  void TakePlace() {
    if (rename(path_.c_str(), target_.c_str()) != 0) Fail("can't replace", target_);
    path_.clear();
    SyncFolder();
  }

 private:
  /// So that the new name is on the disk, too. Not all file systems can; then nothing is lost.
  void SyncFolder() const {
    const int folder = open(folder_.c_str(), O_RDONLY | O_DIRECTORY);
    if (folder < 0) return;
    fsync(folder);
    close(folder);
  }

  std::string target_;
  std::string folder_;
  std::string path_;
  int file_ = -1;
};

}  // namespace

void ReplaceFiles(const std::vector<FileContent>& files) {
  std::list<TemporaryFile> written;
  for (const FileContent& file : files) written.emplace_back(file.path).Write(file.content);
  for (TemporaryFile& file : written) file.TakePlace();
}

void ReplaceFile(const std::string& path, const std::string& content) {
  TemporaryFile file(path);  // not by ReplaceFiles, as the content may be large to copy
  file.Write(content);
  file.TakePlace();
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
