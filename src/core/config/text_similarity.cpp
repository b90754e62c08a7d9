#include "scan_image_slam/core/config/text_similarity.h"

#include <algorithm>

namespace scan_image_slam {
namespace {

/// Edits between two words (Damerau and Levenshtein).
std::size_t EditDistance(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        d[i][j] = i + j;
        continue;
      }
      d[i][j] = std::min(
          {d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0u : 1u)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
      }
    }
  }
  return d[a.size()][b.size()];
}

}  // namespace

std::string MostSimilar(const std::string& word, const std::vector<std::string>& words) {
  return *std::min_element(words.begin(), words.end(),
                           [&](const std::string& a, const std::string& b) {
                             return EditDistance(a, word) < EditDistance(b, word);
                           });
}

bool IsSimilar(const std::string& a, const std::string& b) {
  constexpr double kMostEdits = 0.6;  // per letter of the longer word
  return static_cast<double>(EditDistance(a, b)) <
         kMostEdits * static_cast<double>(std::max(a.size(), b.size()));
}

}  // namespace scan_image_slam
