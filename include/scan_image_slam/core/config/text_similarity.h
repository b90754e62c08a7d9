#pragma once

#include <string>
#include <vector>

namespace scan_image_slam {

/// The word that needs the fewest edits (insert, delete, replace, swap neighbours) to become
/// `word`; the first of several. `words` must not be empty.
std::string MostSimilar(const std::string& word, const std::vector<std::string>& words);

/// True if one may well have been meant by the other.
bool IsSimilar(const std::string& a, const std::string& b);

}  // namespace scan_image_slam
