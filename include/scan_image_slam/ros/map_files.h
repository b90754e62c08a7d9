#pragma once

#include <string>

namespace scan_image_slam {

/// The absolute path of a file that is named from a folder on. Throws std::invalid_argument if the
/// name is empty.
std::string PathFrom(const std::string& folder, const std::string& name);

/// The same, for a file to be written: std::invalid_argument if it lies outside the folder.
std::string PathInside(const std::string& folder, const std::string& name);

}  // namespace scan_image_slam
