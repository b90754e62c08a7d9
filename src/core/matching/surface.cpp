#include "scan_image_slam/core/matching/surface.h"

#include "scan_image_slam/core/fusion/beam_spacing.h"
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

/// The hits of a model, and the number of the surface that each lies on: hits of one run follow
/// each other on one surface.
struct Hits {
  std::vector<SurfacePoint> points;
  std::vector<int> runs;
};

/// A run ends where beams are missing or the range jumps by more than the most grazing wall makes
/// it.
bool SameSurface(const ModelBeam& a, const ModelBeam& b, double spacing, double max_slope) {
  const double angle = AngleBetween(a, b);
  return angle <= (kMaxMissingBeams + 1.5) * spacing &&
         std::abs(b.range - a.range) <= max_slope * std::min(a.range, b.range) * angle;
}

Hits FindHits(const FusedModel& model, double max_incidence) {
  const Eigen::Vector2d laser = model.base_from_laser.translation();
  const double spacing = BeamSpacing(model.beams);
  const double max_slope = std::tan(max_incidence);
  Hits hits;
  hits.points.reserve(model.beams.size());
  hits.runs.reserve(model.beams.size());
  const ModelBeam* last = nullptr;
  int run = 0;
  for (const ModelBeam& beam : model.beams) {
    if (!beam.hit()) continue;
    SurfacePoint p;
    p.point = beam.point;
    p.ray = (beam.point - laser).normalized();
    p.range = beam.range;
    p.time_offset = beam.time_offset;
    if (last != nullptr && !SameSurface(*last, beam, spacing, max_slope)) ++run;
    hits.points.push_back(p);
    hits.runs.push_back(run);
    last = &beam;
  }
  return hits;
}

/// Marks what is no wider than people and stands in front of all that is beside it: one run, or a
/// few, such as two legs of which one hides part of the other.
void MarkDetached(Hits* hits) {
  constexpr double kMostWidth = 0.8;  // [m]
  constexpr int kMostRuns = 4;
  std::vector<SurfacePoint>& points = hits->points;
  std::vector<std::size_t> borders;  // first point of each run, and the end
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i == 0 || hits->runs[i] != hits->runs[i - 1]) borders.push_back(i);
  }
  borders.push_back(points.size());
  for (std::size_t first = 0; first + 1 < borders.size(); ++first) {
    const std::size_t begin = borders[first];
    if (begin > 0 && points[begin - 1].range <= points[begin].range) continue;
    double width = 0.0;
    for (std::size_t last = first + 1; last < borders.size() && last <= first + kMostRuns; ++last) {
      const std::size_t end = borders[last];
      for (std::size_t i = borders[last - 1]; i < end && width <= kMostWidth; ++i) {
        width = std::max(width, (points[i].point - points[begin].point).norm());
      }
      if (width > kMostWidth) break;
      if (end < points.size() && points[end].range <= points[end - 1].range) continue;
      for (std::size_t i = begin; i < end; ++i) points[i].detached = true;
    }
  }
}

/// Shares of the laser's variance: of the points across a line that can't be one wall, and of those
/// that may hide a corner.
constexpr double kMaxScatter = 4.0;
constexpr double kSuspicious = 0.25;
/// Share of the variance of both sides together that makes one side the better line.
constexpr double kFarBetter = 0.25;

/// The line through the points on one side of a point; of no use if they are few.
Line SideLine(const std::vector<PointSums>& sums, int begin, int end) {
  constexpr int kMinSidePoints = 4;  // fewer lie on a line by chance
  Line line;
  if (end - begin >= kMinSidePoints) return FitLine(sums[end] - sums[begin]);
  line.variance = std::numeric_limits<double>::infinity();
  return line;
}

/// The line through a point and its neighbours `left` .. `right` on both sides together; next to a
/// corner, where one side alone fits far better, that side.
Line BestLine(const std::vector<PointSums>& sums, int left, int point, int right,
              double noise_variance) {
  Line line = FitLine(sums[right + 1] - sums[left]);
  if (line.variance <= kSuspicious * noise_variance) return line;
  const Line before = SideLine(sums, left, point + 1);
  const Line after = SideLine(sums, point, right + 1);
  const Line& side = before.variance < after.variance ? before : after;
  return side.variance < kFarBetter * line.variance ? side : line;
}

}  // namespace

std::vector<SurfacePoint> EstimateSurface(const FusedModel& model, const SurfaceOptions& options,
                                          const RangeNoise& noise) {
  Hits hits = FindHits(model, options.max_incidence);
  std::vector<SurfacePoint>& points = hits.points;
  const int count = static_cast<int>(points.size());
  MarkDetached(&hits);
  if (count < kMinLinePoints) return points;

  std::vector<PointSums> sums(points.size() + 1);
  for (int i = 0; i < count; ++i) sums[i + 1] = sums[i].Plus(points[i].point);

  const double squared_radius = options.radius * options.radius;
  const double noise_variance = noise.range_stddev * noise.range_stddev;
  for (int i = 0; i < count; ++i) {
    SurfacePoint& p = points[i];
    const auto is_neighbour = [&](int j) {
      return hits.runs[j] == hits.runs[i] &&
             (std::abs(j - i) <= kMinNeighbours ||
              (points[j].point - p.point).squaredNorm() < squared_radius);
    };
    // Both ways from the point: windows that slide on would lag behind where noise moves points.
    int left = i;
    while (left > 0 && is_neighbour(left - 1)) --left;
    int right = i;
    while (right + 1 < count && is_neighbour(right + 1)) ++right;

    if (right + 1 - left < kMinLinePoints) continue;
    const Line line = BestLine(sums, left, i, right, noise_variance);
    if (line.variance > kMaxScatter * noise_variance) continue;
    const double cosine = line.normal.dot(p.ray);
    p.normal = cosine < 0.0 ? line.normal : Eigen::Vector2d(-line.normal);
    p.angle_variance = std::max(line.variance, noise.VarianceAcross(p.range, cosine)) / line.spread;
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

std::vector<ModelEdge> CorrectSweep(std::vector<ModelEdge> edges, const Velocity2& difference) {
  for (ModelEdge& edge : edges) {
    const Pose2 correction = Move(difference, edge.time_offset);
    edge.camera = correction * edge.camera;
    edge.bearing = NormalizeAngle(edge.bearing + correction.theta);
  }
  return edges;
}

}  // namespace scan_image_slam
