#pragma once

#include <string>

namespace scan_image_slam {

/// Path of a file that the package ships, given relative to the package (e.g. config/default.yaml):
/// in the install space beside the running program, else in the source tree that it was built from.
/// Throws std::runtime_error, naming both places, if it is in neither.
std::string PackageFile(const std::string& relative);

}  // namespace scan_image_slam
