#pragma once

#include <algorithm>
#include <vector>

namespace scan_image_slam {

/// What an edge of a model was good for.
enum class EdgeUse {
  kLeftOut,  ///< weak or far, mistaken easily for one beside it, or perhaps on a person
  kNew,      ///< not known yet
  kMatched,  ///< it has told where the base is
  kRefused,  ///< too far from where it should be
};

struct EdgeMatch {
  EdgeUse use = EdgeUse::kLeftOut;
  double residual = 0.0;  ///< bearing seen less bearing expected, if it was known [rad]
};

inline int CountMatched(const std::vector<EdgeMatch>& edges) {
  return static_cast<int>(std::count_if(edges.begin(), edges.end(), [](const EdgeMatch& edge) {
    return edge.use == EdgeUse::kMatched;
  }));
}

}  // namespace scan_image_slam
