#pragma once

#include <string>
#include <vector>

namespace scan_image_slam {

/// The word that needs the fewest edits (insert, delete, replace, swap neighbours) to become
/// `word`; the first of several. `words` must not be empty.
std::string MostSimilar(const std::string& word, const std::vector<std::string>& words);

}  // namespace scan_image_slam
