#include "scan_image_slam/core/matching/newcomers.h"

#include <algorithm>

namespace scan_image_slam {

void Newcomers::Add(const Eigen::Vector2d& place, int sign, double way) {
  newcomers_.push_back({place, sign, way});
}

bool Newcomers::Take(const Eigen::Vector2d& place, int sign, double reach) {
  const auto newcomer = std::find_if(newcomers_.begin(), newcomers_.end(), [&](const Newcomer& n) {
    return n.sign == sign && (n.place - place).norm() < reach;
  });
  if (newcomer == newcomers_.end()) return false;
  newcomers_.erase(newcomer);
  return true;
}

void Newcomers::ForgetBefore(double way) {
  newcomers_.erase(std::remove_if(newcomers_.begin(), newcomers_.end(),
                                  [&](const Newcomer& n) { return n.seen < way; }),
                   newcomers_.end());
}

}  // namespace scan_image_slam
