#pragma once

#include "fuzz_input.h"

#include <string>

#include <sys/mman.h>
#include <unistd.h>

namespace scan_image_slam {

/// A file in memory that holds the bytes of the fuzzer.
class FuzzFile {
 public:
  FuzzFile(const std::uint8_t* data, std::size_t size) : file_(memfd_create("fuzz", 0)) {
    Require(file_ >= 0 && write(file_, data, size) == static_cast<ssize_t>(size));
  }
  ~FuzzFile() { close(file_); }
  FuzzFile(const FuzzFile&) = delete;
  FuzzFile& operator=(const FuzzFile&) = delete;
  std::string path() const { return "/proc/self/fd/" + std::to_string(file_); }

 private:
  int file_;
};

}  // namespace scan_image_slam
