#pragma once

#include <string>

namespace scan_image_slam {

/// Replaces a file as a whole: after a crash at any moment it holds the old content or the new one.
/// Missing folders are made. Throws std::runtime_error that names the file; the old one is then as
/// it was.
void ReplaceFile(const std::string& path, const std::string& content);

/// All bytes of a file. Throws std::runtime_error that names it.
std::string ReadWholeFile(const std::string& path);

}  // namespace scan_image_slam
