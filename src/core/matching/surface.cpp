#include "scan_image_slam/core/matching/surface.h"

#include "scan_image_slam/core/geometry/line_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace scan_image_slam {
namespace {

constexpr int kMinLinePoints = 3;
/// At far range the beams are wider apart than the radius: so many on each side are taken anyway.
constexpr int kMinNeighbours = 2;
/// Beams without a hit that a surface may bridge.
constexpr int kMaxMissingBeams = 2;

/// A surface point and where it belongs in the sweep.
struct Hit {
  int beam;
  int run;  ///< hits of one run follow each other on one surface
};

std::vector<SurfacePoint> Hits(const FusedModel& model, std::vector<Hit>* hits) {
  std::vector<SurfacePoint> points;
  points.reserve(model.beams.size());
  hits->reserve(model.beams.size());
  const Eigen::Vector2d laser = model.base_from_laser.translation();
  for (std::size_t i = 0; i < model.beams.size(); ++i) {
    const ModelBeam& beam = model.beams[i];
    if (!beam.hit()) continue;
    SurfacePoint p;
    p.point = beam.point;
    p.ray = (beam.point - laser).normalized();
    p.range = beam.range;
    p.time_offset = beam.time_offset;
    points.push_back(p);
    hits->push_back({static_cast<int>(i), 0});
  }
  return points;
}

/// Ends a run where the range jumps by more than the most grazing wall would make it.
void FindRuns(const std::vector<SurfacePoint>& points, double angle_step, double max_incidence,
              std::vector<Hit>* hits) {
  const double max_slope = std::tan(max_incidence);
  for (std::size_t i = 1; i < points.size(); ++i) {
    const int beams = (*hits)[i].beam - (*hits)[i - 1].beam;
    const double across = std::min(points[i].range, points[i - 1].range) * angle_step * beams;
    const bool connected = beams <= 1 + kMaxMissingBeams &&
                           std::abs(points[i].range - points[i - 1].range) <= max_slope * across;
    (*hits)[i].run = (*hits)[i - 1].run + (connected ? 0 : 1);
  }
}

}  // namespace

std::vector<SurfacePoint> EstimateSurface(const FusedModel& model, const SurfaceOptions& options,
                                          const RangeNoise& noise) {
  std::vector<Hit> hits;
  std::vector<SurfacePoint> points = Hits(model, &hits);
  const int count = static_cast<int>(points.size());
  if (count < kMinLinePoints) return points;

  const double angle_step = std::abs(model.beams.back().bearing - model.beams.front().bearing) /
                            static_cast<double>(model.beams.size() - 1);
  FindRuns(points, angle_step, options.max_incidence, &hits);
  std::vector<PointSums> sums(points.size() + 1);
  for (int i = 0; i < count; ++i) sums[i + 1] = sums[i].Plus(points[i].point);

  const double squared_radius = options.radius * options.radius;
  const double max_variance = 4.0 * noise.range_stddev * noise.range_stddev;
  int left = 0;
  int right = 0;
  for (int i = 0; i < count; ++i) {
    SurfacePoint& p = points[i];
    const auto is_neighbour = [&](int j) {
      return hits[j].run == hits[i].run &&
             (std::abs(j - i) <= kMinNeighbours ||
              (points[j].point - p.point).squaredNorm() < squared_radius);
    };
    while (left < i && !is_neighbour(left)) ++left;
    right = std::max(right, i);
    while (right + 1 < count && is_neighbour(right + 1)) ++right;

    double best = std::numeric_limits<double>::infinity();
    const auto try_line = [&](int begin, int end) {
      if (end - begin < kMinLinePoints) return;
      const Line line = FitLine(sums[end] - sums[begin]);
      if (line.variance > max_variance) return;
      const double cosine = line.normal.dot(p.ray);
      const double angle_variance =
          std::max(line.variance, noise.VarianceAcross(p.range, cosine)) / line.spread;
      if (angle_variance >= best) return;
      best = angle_variance;
      p.normal = cosine < 0.0 ? line.normal : Eigen::Vector2d(-line.normal);
      p.angle_variance = angle_variance;
    };
    // Both sides together; next to a corner, where that does not fit, one side alone.
    try_line(left, right + 1);
    if (!p.has_normal()) {
      try_line(left, i + 1);
      try_line(i, right + 1);
    }
  }
  return points;
}

std::vector<SurfacePoint> CorrectSweep(std::vector<SurfacePoint> points,
                                       const Velocity2& difference) {
  for (SurfacePoint& p : points) {
    const RigidTransform2 correction(Move(difference, p.time_offset));
    p.point = correction * p.point;
    p.ray = correction.Rotate(p.ray);
    p.normal = correction.Rotate(p.normal);
  }
  return points;
}

}  // namespace scan_image_slam
