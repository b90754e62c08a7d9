#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace scan_image_slam {

/// One file of the package, by its path from the package's folder.
struct SourceFile {
  std::string path;
  std::vector<std::string> lines;
};

/// The files below some folders of the package that end in one of `endings`, ordered by path.
inline std::vector<SourceFile> FilesBelow(const std::vector<std::string>& folders,
                                          const std::vector<std::string>& endings) {
  namespace fs = std::filesystem;
  const fs::path root = SCAN_IMAGE_SLAM_SOURCE_DIR;
  std::vector<SourceFile> files;
  for (const std::string& folder : folders) {
    if (!fs::exists(root / folder)) continue;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / folder)) {
      const std::string ending = entry.path().extension().string();
      if (std::find(endings.begin(), endings.end(), ending) == endings.end()) continue;
      SourceFile file;
      file.path = entry.path().lexically_relative(root).generic_string();
      std::ifstream stream(entry.path());
      for (std::string line; std::getline(stream, line);) file.lines.push_back(line);
      files.push_back(std::move(file));
    }
  }
  std::sort(files.begin(), files.end(),
            [](const SourceFile& a, const SourceFile& b) { return a.path < b.path; });
  return files;
}

inline bool StartsWith(const std::string& text, const std::string& start) {
  return text.compare(0, start.size(), start) == 0;
}

/// What a file includes, in order, with the quotes or brackets.
inline std::vector<std::string> IncludesOf(const SourceFile& file) {
  const std::string directive = "#include ";
  std::vector<std::string> includes;
  for (const std::string& line : file.lines) {
    if (StartsWith(line, directive)) includes.push_back(line.substr(directive.size()));
  }
  return includes;
}

/// A line without its comment and without what stands in quotes.
inline std::string CodeOf(const std::string& line) {
  std::string code;
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (quoted && line[i] == '\\') {
      ++i;
      continue;
    }
    if (line[i] == '"') quoted = !quoted;
    if (!quoted && line.compare(i, 2, "//") == 0) break;
    if (!quoted) code.push_back(line[i]);
  }
  return code;
}

}  // namespace scan_image_slam
