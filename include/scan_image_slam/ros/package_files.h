#pragma once

#include <string>

namespace scan_image_slam {

/// Path of a file that the package ships, given relative to the package (e.g. config/default.yaml):
/// in the install space beside the running program, else in the source tree that it was built from.
/// Throws std::runtime_error, naming both places, if it is in neither.
std::string PackageFile(const std::string& relative);

/// Path of a world: that of a file, or the name of a shipped one (e.g. corridor). Throws
/// std::runtime_error if there is none.
std::string FindWorld(const std::string& world);

}  // namespace scan_image_slam
