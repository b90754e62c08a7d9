#pragma once

#include <vector>

#include <Eigen/Core>

namespace scan_image_slam {

/// Part of the plan where the light or the view differs.
struct LightRegion {
  Eigen::Vector2d low{0, 0};   ///< corner of a rectangle along the axes, world frame [m]
  Eigen::Vector2d high{0, 0};  ///< opposite corner [m]
  double brightness = 1.0;     ///< factor on the light inside
  double border = 1.0;         ///< width of the gradual change, inside the rectangle [m]
  double blur = 0.0;           ///< defocus of a camera inside, e.g. from mist or steam [px]
};

/// A lamp under the ceiling, seen as a highlight in glossy walls.
struct Lamp {
  Eigen::Vector2d position{0, 0};  ///< [m]
  double height = 2.5;             ///< [m]
};

struct Lighting {
  double brightness = 1.0;
  double flicker = 0.0;              ///< amplitude of the lamps' flicker, fraction of the light
  double flicker_frequency = 100.0;  ///< [Hz]
  double highlights = 0.0;           ///< strength of the lamps' mirror images on walls, 0 none
  double shadows = 0.0;              ///< strength of the robot's own shadow on walls, 0 none
  std::vector<LightRegion> regions;
  std::vector<Lamp> lamps;
};

/// How deep `point` lies in the region: 0 outside, 1 where the change is complete.
double Depth(const LightRegion& region, const Eigen::Vector2d& point);

/// Light at a place of the plan, without flicker.
double BrightnessAt(const Lighting& lighting, const Eigen::Vector2d& point);

/// At least as bright as any place is.
double PeakBrightness(const Lighting& lighting);

/// Defocus of a camera at a place of the plan [px].
double BlurAt(const Lighting& lighting, const Eigen::Vector2d& point);

/// Mean factor of the flicker over an exposure around `time` [s].
double FlickerFactor(const Lighting& lighting, double time, double exposure);

}  // namespace scan_image_slam
