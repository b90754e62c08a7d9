#pragma once

#include <string>

namespace scan_image_slam {

/// Reads through a bag the way rosbag will: rosbag believes the lengths and places that it finds in
/// a file, and reads, allocates or jumps as they say. Throws std::runtime_error, naming the byte,
/// if one does not fit. A bag that was not closed, and so has no index yet, is left to rosbag,
/// which tells it from others.
void CheckBag(const std::string& path);

}  // namespace scan_image_slam
