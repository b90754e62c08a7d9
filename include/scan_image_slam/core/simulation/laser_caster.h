#pragma once

#include "scan_image_slam/core/simulation/world.h"

#include <limits>
#include <vector>

#include <Eigen/Core>

namespace scan_image_slam {

/// One beam at its own firing time, in the world frame.
struct LaserRay {
  Eigen::Vector2d origin{0, 0};     ///< [m]
  Eigen::Vector2d direction{1, 0};  ///< unit vector
};

/// What a ray meets first.
struct LaserHit {
  double range = std::numeric_limits<double>::infinity();  ///< [m]
  double cosine = 1.0;  ///< of the angle between the ray and the surface's normal, in [0, 1]
  int surface = -1;     ///< index into World::walls, -2 - n for the n-th person, -1 nothing
};

/// A sweep: beams in the order of firing, each of several rays across the width of the spot.
struct LaserFan {
  int rays_per_beam = 1;
  std::vector<LaserRay> rays;    ///< beam by beam, middle ray of beam b at b * n + n / 2
  std::vector<double> bearings;  ///< of the middle rays, world frame, not wrapped, monotonic [rad]
  std::vector<double> times;     ///< of the beams, since the start of the simulation [s]
  double half_width = 0.0;       ///< largest angle from a middle ray to another of its beam [rad]

  std::size_t beams() const { return bearings.size(); }
};

struct LaserHits {
  std::vector<LaserHit> solid;  ///< per ray: the first surface that is not glass
  std::vector<LaserHit> glass;  ///< per ray: the first glass
};

/// Intersects the sweeps of a laser with all walls at its height and with people's legs. Each wall
/// is tried only with the beams that can reach it, however far the robot moves during the sweep.
class LaserCaster {
 public:
  /// `world` must outlive the caster. `height` of the laser's plane above the floor [m].
  LaserCaster(const World& world, double height);

  LaserHits Cast(const LaserFan& fan) const;

 private:
  struct Target {
    Eigen::Vector2d from;
    Eigen::Vector2d edge;    // to - from
    Eigen::Vector2d normal;  // unit vector
    int wall;
    bool glass;
  };

  const World& world_;
  std::vector<Target> targets_;
};

}  // namespace scan_image_slam
