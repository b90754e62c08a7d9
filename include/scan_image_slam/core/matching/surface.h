#pragma once

#include "scan_image_slam/core/fusion/fused_model.h"

#include <vector>

#include <Eigen/Core>

namespace scan_image_slam {

/// A measured point and the piece of surface it lies on, in the base frame.
struct SurfacePoint {
  Eigen::Vector2d point{0, 0};   ///< [m]
  Eigen::Vector2d ray{1, 0};     ///< unit vector from the laser to the point
  Eigen::Vector2d normal{0, 0};  ///< unit vector towards the laser; zero where no line fits
  double range = 0.0;            ///< [m]
  double angle_variance = 0.0;   ///< of the direction of the normal [rad^2]
  double time_offset = 0.0;      ///< firing time since the stamp of the scan [s]
  bool detached = false;         ///< on something small with farther things on both sides

  bool has_normal() const { return normal.squaredNorm() > 0.5; }
};

/// How precisely the laser measures.
struct RangeNoise {
  double range_stddev = 0.02;     ///< of a range [m]
  double bearing_stddev = 0.001;  ///< of a bearing [rad]

  /// Variance across a surface of a point measured at `range`, where `cosine` is that of the angle
  /// between the ray and the surface's normal [m^2].
  double VarianceAcross(double range, double cosine) const {
    const double along_ray = range_stddev * cosine;
    const double across_ray = bearing_stddev * range;
    return along_ray * along_ray + across_ray * across_ray;
  }
};

struct SurfaceOptions {
  double radius = 0.15;        ///< half length of the line fitted around a point [m]
  double max_incidence = 1.5;  ///< ray to normal, of the most grazing wall that is followed [rad]
};

/// The hits of a model, each with the normal of the line through its neighbours in the sweep.
std::vector<SurfacePoint> EstimateSurface(const FusedModel& model, const SurfaceOptions& options,
                                          const RangeNoise& noise);

/// Moves each point by what the base moved differently from what was thought, `difference`, since
/// its beam fired.
std::vector<SurfacePoint> CorrectSweep(std::vector<SurfacePoint> points,
                                       const Velocity2& difference);

/// The same for edges, since the image was taken that shows them: wheels that slip turn an image
/// that is 30 ms old by many columns.
std::vector<ModelEdge> CorrectSweep(std::vector<ModelEdge> edges, const Velocity2& difference);

}  // namespace scan_image_slam
