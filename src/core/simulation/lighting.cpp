#include "scan_image_slam/core/simulation/lighting.h"

#include <algorithm>
#include <cmath>

namespace scan_image_slam {

double Depth(const LightRegion& region, const Eigen::Vector2d& point) {
  const Eigen::Vector2d inside =
      (point - region.low).cwiseMin(region.high - point);  // distance to the nearer border
  const double distance = inside.minCoeff();
  if (distance <= 0.0) return 0.0;
  const double x = region.border > 0.0 ? std::min(distance / region.border, 1.0) : 1.0;
  return x * x * (3.0 - 2.0 * x);  // without a visible line where the change begins
}

double BrightnessAt(const Lighting& lighting, const Eigen::Vector2d& point) {
  double brightness = lighting.brightness;
  for (const LightRegion& region : lighting.regions) {
    brightness *= 1.0 + Depth(region, point) * (region.brightness - 1.0);
  }
  return brightness;
}

double PeakBrightness(const Lighting& lighting) {
  double peak = lighting.brightness;
  for (const LightRegion& region : lighting.regions) peak *= std::max(1.0, region.brightness);
  return peak;
}

double BlurAt(const Lighting& lighting, const Eigen::Vector2d& point) {
  double blur = 0.0;
  for (const LightRegion& region : lighting.regions) {
    blur = std::max(blur, Depth(region, point) * region.blur);
  }
  return blur;
}

double FlickerFactor(const Lighting& lighting, double time, double exposure) {
  const double half = M_PI * lighting.flicker_frequency * exposure;
  const double averaged = half > 1e-9 ? std::sin(half) / half : 1.0;
  return 1.0 +
         lighting.flicker * averaged * std::sin(2.0 * M_PI * lighting.flicker_frequency * time);
}

}  // namespace scan_image_slam
