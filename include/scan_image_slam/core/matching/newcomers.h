#pragma once

#include <vector>

#include <Eigen/Core>

namespace scan_image_slam {

/// Edges that one image has shown, and that begin to count with the next that shows them.
class Newcomers {
 public:
  /// At a place in the map [m], after so much way [m].
  void Add(const Eigen::Vector2d& place, int sign, double way);
  /// True if one of this sign is known within `reach` of a place; it is no newcomer any more.
  bool Take(const Eigen::Vector2d& place, int sign, double reach);
  void ForgetBefore(double way);
  void Clear() { newcomers_.clear(); }

 private:
  struct Newcomer {
    Eigen::Vector2d place{0, 0};
    int sign = 0;
    double seen = 0.0;  // way
  };
  std::vector<Newcomer> newcomers_;
};

}  // namespace scan_image_slam
