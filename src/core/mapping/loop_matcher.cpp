#include "scan_image_slam/core/mapping/loop_matcher.h"

#include "scan_image_slam/core/geometry/covariance.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace scan_image_slam {
namespace {

/// One point for each square of a grid.
std::vector<Eigen::Vector2d> Thin(const std::vector<SurfacePoint>& points, double spacing) {
  std::set<std::pair<int, int>> taken;
  std::vector<Eigen::Vector2d> thin;
  for (const SurfacePoint& p : points) {
    const std::pair<int, int> square(static_cast<int>(std::floor(p.point.x() / spacing)),
                                     static_cast<int>(std::floor(p.point.y() / spacing)));
    if (taken.insert(square).second) thin.push_back(p.point);
  }
  return thin;
}

/// Counts the points that lie on a wall of the submap that faces the same way, and those that lie
/// where the submap has seen nothing; the others are beyond what it knows.
void Compare(const LoopQuery& query, const Submap& submap, const LoopMatcherOptions& options,
             LoopMatch* match) {
  const RigidTransform2 transform(match->submap_from_base);
  int matched = 0;
  int contradicted = 0;
  for (const SurfacePoint& p : query.points) {
    const Eigen::Vector2d place = transform * p.point;
    const SurfaceElement* element = submap.local_map().Nearest(place);
    if (element == nullptr) {
      if (submap.seen().IsFree(place)) ++contradicted;
      continue;
    }
    const Eigen::Vector2d offset = place - element->position.cast<double>();
    const bool same_side =
        !p.has_normal() || transform.Rotate(p.normal).dot(element->normal.cast<double>()) >=
                               options.refinement.min_normal_cosine;
    if (offset.norm() <= options.match_distance && same_side) {
      ++matched;
    } else if (submap.seen().IsFree(place)) {
      ++contradicted;
    }
  }
  match->agreement = static_cast<double>(matched) / std::max(1, matched + contradicted);
  const double points = static_cast<double>(std::max<std::size_t>(1, query.points.size()));
  match->overlap = matched / points;
  match->contradiction = contradicted / points;
}

/// Step of the search in angle at which the far points move by about one cell.
double AngleStep(const std::vector<Eigen::Vector2d>& points, double cell_size) {
  double squares = 0.0;
  for (const Eigen::Vector2d& p : points) squares += p.squaredNorm();
  const double mean_range = std::sqrt(squares / static_cast<double>(points.size()));
  return std::clamp(1.5 * cell_size / mean_range, 0.008, 0.05);
}

/// True if a wall of the submap stands between the laser and a point, well before it.
bool IsBehindWall(const SurfacePoint& point, const Submap& submap,
                  const RigidTransform2& submap_from_base) {
  constexpr double kStep = 0.1;       // along the ray [m]
  constexpr double kBegin = 0.3;      // nearer to the laser nothing is looked at [m]
  constexpr double kBehind = 0.5;     // at least, of the point behind the wall [m]
  constexpr double kAcross = 0.05;    // from the wall that counts as met [m]
  constexpr double kMinCosine = 0.5;  // between ray and normal: walls beside the ray hide nothing
  const Eigen::Vector2d end = submap_from_base * point.point;
  const Eigen::Vector2d ray = submap_from_base.Rotate(point.ray);
  for (double left = point.range - kBegin; left > kBehind; left -= kStep) {
    const Eigen::Vector2d place = end - left * ray;
    const SurfaceElement* wall = submap.local_map().Nearest(place);
    if (wall == nullptr) continue;
    const Eigen::Vector2d normal = wall->normal.cast<double>();
    const Eigen::Vector2d offset = place - wall->position.cast<double>();
    // What others have looked through was there for a moment only.
    if (-normal.dot(ray) > kMinCosine && std::abs(normal.dot(offset)) < kAcross &&
        offset.norm() < kStep && !submap.seen().IsFree(wall->position.cast<double>())) {
      return true;
    }
  }
  return false;
}

}  // namespace

double ShareBehindWalls(const LoopQuery& query, const Submap& submap,
                        const Pose2& submap_from_base) {
  const RigidTransform2 transform(submap_from_base);
  const auto behind =
      std::count_if(query.points.begin(), query.points.end(),
                    [&](const SurfacePoint& p) { return IsBehindWall(p, submap, transform); });
  return static_cast<double>(behind) /
         std::max<double>(1.0, static_cast<double>(query.points.size()));
}

LoopMatch RefineInSubmap(const LoopQuery& query, const Submap& submap,
                         const Pose2& submap_from_base, const LoopMatcherOptions& options) {
  MotionPrior prior;
  prior.map_from_base = submap_from_base;
  prior.covariance = DiagonalCovariance(options.prior_distance, options.prior_angle);
  prior.kernel = 3.0;
  const EdgeEvidence evidence{query.edges, submap.edge_map()};
  const Refinement refined = Refine(query.points, submap.local_map(), options.noise, prior,
                                    submap_from_base, options.refinement, &evidence);
  LoopMatch match;
  match.submap_from_base = refined.map_from_base;
  match.information = refined.information;
  Compare(query, submap, options, &match);
  return match;
}

std::optional<LoopMatch> TrackInSubmap(const LoopQuery& query, const Submap& submap,
                                       const Pose2& submap_from_base,
                                       const LoopMatcherOptions& options) {
  const LoopMatch match = RefineInSubmap(query, submap, submap_from_base, options);
  if (match.agreement < options.min_agreement || match.overlap < options.min_overlap) {
    return std::nullopt;
  }
  return match;
}

std::optional<LoopMatch> FindInSubmap(const LoopQuery& query, Submap* submap,
                                      const PoseWindow& window, const LoopMatcherOptions& options) {
  const std::vector<Eigen::Vector2d> points = Thin(query.points, options.search_spacing);
  if (points.empty()) return std::nullopt;
  const double step = AngleStep(points, submap->pyramid().cell_size());
  const std::optional<ScoredPose> best =
      SearchBest(submap->pyramid(), points, window, step, options.min_score);
  if (!best) return std::nullopt;
  const SearchExclusion same{best->map_from_base, options.rival_distance, options.rival_angle};
  if (SearchBest(submap->pyramid(), points, window, step, options.rival_score * best->score,
                 same)) {
    return std::nullopt;
  }
  return TrackInSubmap(query, *submap, best->map_from_base, options);
}

}  // namespace scan_image_slam
