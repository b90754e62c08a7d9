#pragma once

#include "scan_image_slam/core/geometry/pose2.h"
#include "scan_image_slam/core/sensor/stamp.h"

#include <cmath>
#include <vector>

#include <Eigen/Core>

namespace scan_image_slam {

/// One element m_i of the paper's model: the range of a beam and the edge that the camera sees
/// there.
struct ModelBeam {
  double bearing = 0.0;         ///< theta, in the frame of the laser [rad]
  double range = 0.0;           ///< l [m]; +Inf: no object within reach; NaN: unknown
  double time_offset = 0.0;     ///< when the beam was fired, since the stamp of the model [s]
  Eigen::Vector2d point{0, 0};  ///< in the base frame at the stamp, sweep corrected [m]; if hit()
  double edge_weight = 0.0;     ///< share of the region of interest that is vertical edge here [-]
  int edge_sign = 0;            ///< +1: darker on the left; -1: darker on the right; 0: no edge

  bool hit() const { return std::isfinite(range); }
};

/// A vertical edge as the camera sees it: exact in bearing, on the surface that the laser sees
/// there.
struct ModelEdge {
  Eigen::Vector2d camera{0,
                         0};    ///< centre of the camera in the base frame at the model's stamp [m]
  double bearing = 0.0;         ///< from the camera, in the base frame at the stamp [rad]
  double bearing_stddev = 0.0;  ///< [rad]
  double range = 0.0;           ///< from the camera to the surface, horizontally [m]
  double range_stddev = 0.0;    ///< [m]
  double range_by_bearing = 0.0;  ///< how the range along the surface grows with it [m/rad]
  double time_offset = 0.0;       ///< when the image was taken, since the stamp of the model [s]
  int sign = 0;                   ///< +1: darker on the left; -1: darker on the right
  double weight = 0.0;    ///< share of the region of interest that is vertical edge here [-]
  double contrast = 0.0;  ///< step at the edge [grey levels]
  int id = 0;             ///< told by the matching: its place among the edges of its model

  Eigen::Vector2d point() const {
    return camera + range * Eigen::Vector2d(std::cos(bearing), std::sin(bearing));
  }
};

/// The paper's ICP model M: what a scan and the image nearest to it say of the surroundings.
struct FusedModel {
  Stamp stamp = 0;               ///< time of the first beam of the scan [ns]
  Pose2 base_from_laser;         ///< where the rays start; the angle is that of bearing 0
  bool upside_down = false;      ///< bearings grow clockwise, seen from above
  Velocity2 sweep_velocity;      ///< of the base, that the points were corrected with
  bool has_image = false;        ///< an image was fused, with or without edges
  std::vector<ModelBeam> beams;  ///< in the order of the scan
  std::vector<ModelEdge> edges;

  /// Direction of a beam in the base frame [rad].
  double HeadingOf(const ModelBeam& beam) const {
    return base_from_laser.theta + (upside_down ? -beam.bearing : beam.bearing);
  }
};

}  // namespace scan_image_slam
