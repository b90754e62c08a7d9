#pragma once

#include <string>
#include <vector>

namespace scan_image_slam {

struct FileContent {
  std::string path;
  std::string content;
};

/// Replaces files as a whole: after a crash at any moment each holds the old content or the new
/// one. Missing folders are made. Nothing is replaced before all are written: throws
/// std::runtime_error that names the file that cannot be; the old ones are then as they were.
void ReplaceFiles(const std::vector<FileContent>& files);
void ReplaceFile(const std::string& path, const std::string& content);

/// All bytes of a file. Throws std::runtime_error that names it.
std::string ReadWholeFile(const std::string& path);

}  // namespace scan_image_slam
