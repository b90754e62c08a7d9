#include "scan_image_slam/core/mapping/keyframe.h"

namespace scan_image_slam {

Keyframe MakeKeyframe(const FusedModel& model, const MatchedMotion& match,
                      const KeyframeOptions& options) {
  Keyframe keyframe;
  keyframe.stamp = model.stamp;
  keyframe.laser = model.base_from_laser.translation();
  keyframe.edges = CorrectSweep(model.edges, match.edge_correction);
  const std::vector<SurfacePoint> points =
      CorrectSweep(EstimateSurface(model, options.surface, options.noise), match.sweep_correction);
  const SurfacePoint* last = nullptr;
  for (const SurfacePoint& p : points) {
    if (last != nullptr && (p.point - last->point).norm() < options.point_spacing) continue;
    last = &p;
    keyframe.points.push_back(
        {p.point.cast<float>(), p.normal.cast<float>(), static_cast<float>(p.angle_variance)});
  }
  return keyframe;
}

std::vector<SurfacePoint> ToSurfacePoints(const Keyframe& keyframe, const Pose2& target_from_base) {
  const RigidTransform2 transform(target_from_base);
  std::vector<SurfacePoint> points;
  points.reserve(keyframe.points.size());
  for (const KeptPoint& kept : keyframe.points) {
    const Eigen::Vector2d in_base = kept.point.cast<double>();
    const Eigen::Vector2d from_laser = in_base - keyframe.laser;
    SurfacePoint p;
    p.range = from_laser.norm();
    p.point = transform * in_base;
    p.ray = transform.Rotate(from_laser / p.range);
    p.normal = transform.Rotate(kept.normal.cast<double>());
    p.angle_variance = kept.angle_variance;
    points.push_back(p);
  }
  return points;
}

}  // namespace scan_image_slam
