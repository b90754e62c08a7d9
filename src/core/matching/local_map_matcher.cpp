#include "scan_image_slam/core/matching/local_map_matcher.h"

#include "scan_image_slam/core/geometry/covariance.h"

#include <algorithm>
#include <cmath>

namespace scan_image_slam {
namespace {

/// Points that represent a scan in the search: evenly spaced along the walls, and ordered so that
/// any first few of them represent the whole, because then bad candidates are given up early.
std::vector<Eigen::Vector2d> SearchPoints(const std::vector<SurfacePoint>& points, double spacing) {
  constexpr std::size_t kStride = 7;
  std::vector<Eigen::Vector2d> spaced;
  for (const SurfacePoint& p : points) {
    if (spaced.empty() || (p.point - spaced.back()).norm() >= spacing) spaced.push_back(p.point);
  }
  std::vector<Eigen::Vector2d> ordered;
  ordered.reserve(spaced.size());
  for (std::size_t first = 0; first < kStride; ++first) {
    for (std::size_t i = first; i < spaced.size(); i += kStride) ordered.push_back(spaced[i]);
  }
  return ordered;
}

/// Moves each point by what the base moved differently from what was thought, since its beam fired.
void CorrectSweep(const Velocity2& difference, std::vector<SurfacePoint>* points) {
  for (SurfacePoint& p : *points) {
    const RigidTransform2 correction(Move(difference, p.time_offset));
    p.point = correction * p.point;
    p.ray = correction.Rotate(p.ray);
    p.normal = correction.Rotate(p.normal);
  }
}

/// True if a wrong velocity displaces the sweep by more than a fraction of the laser's precision.
bool MattersForSweep(const Velocity2& velocity, const std::vector<SurfacePoint>& points) {
  constexpr double kAngle = 0.001;     // [rad]
  constexpr double kDistance = 0.002;  // [m]
  const double sweep = points.empty() ? 0.0 : std::abs(points.back().time_offset);
  return std::abs(velocity.theta) * sweep > kAngle ||
         std::hypot(velocity.x, velocity.y) * sweep > kDistance;
}

}  // namespace

LocalMapMatcher::LocalMapMatcher(const LocalMapMatcherOptions& options)
    : options_(options), local_map_(options.local_map, options.noise), edge_map_(options.edge_map) {
  options_.grid.Validate();
  options_.refinement.Validate();
}

void LocalMapMatcher::Start(const FusedModel& model, const Pose2& map_from_base) {
  InsertIfMoved(EstimateSurface(model, options_.surface, options_.noise), map_from_base);
  edge_map_.Insert(DistinctEdges(model.edges, options_.edge_map), map_from_base,
                   Eigen::Matrix3d::Zero());
}

SearchResult LocalMapMatcher::Search(const std::vector<SurfacePoint>& points,
                                     const Pose2& map_from_predicted,
                                     const MotionPrediction& prediction) const {
  const std::vector<Eigen::Vector2d> representatives = SearchPoints(points, options_.point_spacing);
  const std::vector<Candidate> candidates =
      MakeCandidates(prediction.window, options_.grid, !prediction.from_encoders);
  const double count = std::max<double>(1.0, static_cast<double>(representatives.size()));
  return SearchExhaustively(
      candidates, prediction.window, options_.grid,
      [&](const ArcCoordinates& deviation, double limit) {
        const RigidTransform2 map_from_candidate(map_from_predicted *
                                                 FromArcCoordinates(deviation));
        const double limit_of_sum = limit * count;
        double sum = 0.0;
        for (const Eigen::Vector2d& p : representatives) {
          sum += local_map_.Distance(map_from_candidate * p, options_.max_distance);
          if (sum >= limit_of_sum) break;
        }
        return sum / count;
      });
}

MatchOutcome LocalMapMatcher::Match(const FusedModel& model, const Pose2& map_from_last,
                                    const Eigen::Matrix3d& covariance,
                                    const MotionPrediction& prediction) {
  std::vector<SurfacePoint> points = EstimateSurface(model, options_.surface, options_.noise);
  const std::vector<ModelEdge> edges = DistinctEdges(model.edges, options_.edge_map);
  MatchOutcome outcome;
  if (!prediction.from_encoders) {
    outcome.sweep_correction = VelocityOf(prediction.motion, prediction.dt);
    CorrectSweep(outcome.sweep_correction, &points);
  }
  const Pose2 map_from_predicted = map_from_last * prediction.motion;
  const SearchResult found = Search(points, map_from_predicted, prediction);

  MotionPrior prior;
  prior.map_from_base = map_from_predicted;
  prior.covariance = TransportCovariance(covariance, prediction.motion) + prediction.covariance;
  prior.kernel = options_.prior_kernel;
  const auto refine_from = [&](const Pose2& start) {
    return Refine(points, local_map_, edges, edge_map_, options_.noise, prior, start,
                  options_.refinement);
  };
  Refinement refined = refine_from(map_from_predicted * FromArcCoordinates(found.deviation));
  const Velocity2 error =
      VelocityOf(map_from_predicted.Inverse() * refined.map_from_base, prediction.dt);
  if (MattersForSweep(error, points)) {
    CorrectSweep(error, &points);
    outcome.sweep_correction = outcome.sweep_correction + error;
    refined = refine_from(refined.map_from_base);
  }

  const ArcCoordinates deviation =
      ToArcCoordinates(map_from_predicted.Inverse() * refined.map_from_base);
  outcome.on_window_edge = !prediction.window.Contains(deviation);
  outcome.deviation = prediction.window.Clamp(deviation);
  outcome.covariance = refined.covariance;
  outcome.e = found.e;
  outcome.rms = refined.rms;
  outcome.candidates = found.candidates;
  outcome.points = static_cast<int>(points.size());
  outcome.matched = refined.matched;
  outcome.degenerate = refined.degenerate;
  outcome.degenerate_direction = refined.degenerate_direction;
  const bool trustworthy =
      !outcome.on_window_edge && refined.matched >= options_.min_matched_fraction * outcome.points;
  if (trustworthy) {
    const Pose2 map_from_base = map_from_predicted * FromArcCoordinates(outcome.deviation);
    InsertIfMoved(points, map_from_base);
    edge_map_.Insert(edges, map_from_base, outcome.covariance);
  }
  return outcome;
}

void LocalMapMatcher::InsertIfMoved(const std::vector<SurfacePoint>& points,
                                    const Pose2& map_from_base) {
  const Pose2 moved = map_from_inserted_.Inverse() * map_from_base;
  if (inserted_ >= options_.insert_first && moved.translation().norm() < options_.insert_distance &&
      std::abs(moved.theta) < options_.insert_angle) {
    return;
  }
  local_map_.Insert(points, map_from_base);
  map_from_inserted_ = map_from_base;
  ++inserted_;
}

}  // namespace scan_image_slam
