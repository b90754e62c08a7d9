#pragma once

#include "scan_image_slam/core/matching/refinement.h"
#include "support_rooms.h"

#include <vector>

namespace scan_image_slam {

/// What Refine needs, with defaults that leave all to the scan.
struct RefinementProblem {
  RangeNoise noise;
  LocalMap map{LocalMapOptions(), RangeNoise()};
  EdgeMap edge_map{EdgeMapOptions()};
  std::vector<SurfacePoint> points;
  std::vector<ModelEdge> edges;
  MotionPrior prior;
  RefinementOptions options;

  RefinementProblem() { prior.covariance *= 1e4; }

  Refinement From(const Pose2& start) const {
    const EdgeEvidence evidence{edges, edge_map};
    return Refine(points, map, noise, prior, start, options, &evidence);
  }
};

inline std::vector<SurfacePoint> SurfaceSeen(const Room& room, const Pose2& room_from_base,
                                             const TestLaser& laser = TestLaser(),
                                             TestRandom* random = nullptr) {
  return EstimateSurface(ModelOf(room, room_from_base, 0, laser, random), SurfaceOptions(),
                         RangeNoise());
}

/// A point on a wall across the x axis, seen at right angles.
inline SurfacePoint PointAhead(double x, double y) {
  SurfacePoint p;
  p.point = {x, y};
  p.ray = {1.0, 0.0};
  p.normal = {-1.0, 0.0};
  p.range = x;
  p.angle_variance = 0.01;
  return p;
}

/// Points of a wall at x, one each 0.1 m over `half_length` to both sides.
inline std::vector<SurfacePoint> WallAhead(double x, int half_length_dm) {
  std::vector<SurfacePoint> points;
  for (int i = -half_length_dm; i <= half_length_dm; ++i) points.push_back(PointAhead(x, 0.1 * i));
  return points;
}

}  // namespace scan_image_slam
