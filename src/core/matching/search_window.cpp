#include "scan_image_slam/core/matching/search_window.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace scan_image_slam {

void MotionBounds::Validate() const {
  const auto require = [](double value, const char* name) {
    if (!(std::isfinite(value) && value >= 0.0)) {
      throw std::invalid_argument(std::string(name) + " must be finite and not negative");
    }
  };
  require(distance_per_distance, "distance_per_distance");
  require(distance_per_angle, "distance_per_angle");
  require(distance_per_time, "distance_per_time");
  require(min_distance, "min_distance");
  require(angle_per_angle, "angle_per_angle");
  require(angle_per_distance, "angle_per_distance");
  require(angle_per_time, "angle_per_time");
  require(min_angle, "min_angle");
  require(lateral_per_distance, "lateral_per_distance");
  require(max_time, "max_time");
}

bool SearchWindow::Contains(const ArcCoordinates& deviation) const {
  return std::abs(deviation.distance) <= half_distance &&
         std::abs(deviation.lateral) <= half_lateral && std::abs(deviation.angle) <= half_angle;
}

ArcCoordinates SearchWindow::Clamp(const ArcCoordinates& deviation) const {
  return {std::clamp(deviation.distance, -half_distance, half_distance),
          std::clamp(deviation.lateral, -half_lateral, half_lateral),
          std::clamp(deviation.angle, -half_angle, half_angle)};
}

SearchWindow MakeWindow(const Pose2& motion, double dt, const MotionBounds& bounds) {
  const double distance = motion.translation().norm();
  const double angle = std::abs(motion.theta);
  const double time = std::clamp(dt, 0.0, bounds.max_time);
  SearchWindow window;
  window.half_distance = bounds.min_distance + bounds.distance_per_distance * distance +
                         bounds.distance_per_angle * angle + bounds.distance_per_time * time;
  window.half_lateral = bounds.lateral_per_distance * window.half_distance;
  window.half_angle =
      std::min(M_PI, bounds.min_angle + bounds.angle_per_angle * angle +
                         bounds.angle_per_distance * distance + bounds.angle_per_time * time);
  return window;
}

}  // namespace scan_image_slam
