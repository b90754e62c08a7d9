#pragma once

#include <cstddef>

namespace scan_image_slam {

/// Bounds what this process may ask the system for, and returns the bound [byte]. roscpp makes room
/// for as many elements as a message claims to have before it looks for them, so that one forged
/// length takes gigabytes; beyond the bound it leaves the message out, and says so. A quarter of
/// the machine's memory, as several nodes may hear the same message; at least 2 GiB, and always on
/// top of what the process has already.
std::size_t LimitMemory();

}  // namespace scan_image_slam
