#include "scan_image_slam/core/matching/local_map_matcher.h"

#include "scan_image_slam/core/geometry/covariance.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace scan_image_slam {
namespace {

/// After so many scans that show nothing known, the surroundings are taken for new ones.
constexpr int kMaxUnmatched = 20;

/// Of a scan's points, to believe a match when the robot may be outside of the window.
constexpr double kMost = 0.6;

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

/// The velocity that makes up the motion found `dt` seconds after the last scan. The motion is not
/// that between the stamps alone: the beams were fired later, half a sweep in the mean.
Velocity2 VelocityOverSweep(const Pose2& motion, double dt,
                            const std::vector<SurfacePoint>& points) {
  double late = 0.0;
  for (const SurfacePoint& p : points) late += p.time_offset / static_cast<double>(points.size());
  return VelocityOf(motion, std::max(0.5 * dt, dt + late));
}

/// True if a wrong velocity displaces the sweep by more than what a scan can tell: half of its
/// turn would be an error of the heading.
bool MattersForSweep(const Velocity2& velocity, const std::vector<SurfacePoint>& points) {
  constexpr double kAngle = 1e-4;      // [rad]
  constexpr double kDistance = 0.002;  // [m]
  const double sweep = points.empty() ? 0.0 : std::abs(points.back().time_offset);
  return std::abs(velocity.theta) * sweep > kAngle ||
         std::hypot(velocity.x, velocity.y) * sweep > kDistance;
}

}  // namespace

void LocalMapMatcherOptions::Validate() const {
  grid.Validate();
  local_map.Validate();
  filter.Validate();
  refinement.Validate();
}

LocalMapMatcher::LocalMapMatcher(const LocalMapMatcherOptions& options)
    : options_(options), local_map_(options.local_map, options.noise), filter_(options.filter) {
  options_.Validate();
}

void LocalMapMatcher::SetOptions(const LocalMapMatcherOptions& options) {
  const RangeNoise noise = options_.noise;
  options_ = options;
  options_.noise = noise;
  filter_.SetOptions(options.filter);
}

void LocalMapMatcher::Start(const FusedModel& model, const Pose2& map_from_base) {
  InsertIfMoved(EstimateSurface(model, options_.surface, options_.noise), map_from_base);
  filter_.Start(map_from_base);
  filter_.AddEdges(DistinctEdges(model.edges, options_.filter.edges));
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

LocalMapMatcher::Alignment LocalMapMatcher::Align(const FusedModel& model,
                                                  const Pose2& map_from_last,
                                                  const MotionPrediction& prediction) const {
  const Pose2 map_from_predicted = map_from_last * prediction.motion;
  Alignment alignment;
  alignment.points = EstimateSurface(model, options_.surface, options_.noise);
  if (!prediction.from_encoders) {
    alignment.sweep_correction =
        VelocityOf(prediction.motion, prediction.dt) - model.sweep_velocity;
    alignment.points = CorrectSweep(std::move(alignment.points), alignment.sweep_correction);
  }
  std::vector<SurfacePoint> standing = Standing(alignment.points, map_from_predicted);
  alignment.found = Search(standing, map_from_predicted, prediction);

  MotionPrior prior;
  prior.map_from_base = map_from_predicted;
  prior.covariance = TransportCovariance(filter_.CovarianceFromAnchor(), prediction.motion) +
                     prediction.covariance;
  prior.kernel = options_.prior_kernel;
  const auto refine_from = [&](const Pose2& start) {
    return Refine(standing, local_map_, options_.noise, prior, start, options_.refinement);
  };
  Refinement& refined = alignment.refined;
  refined = refine_from(map_from_predicted * FromArcCoordinates(alignment.found.deviation));
  // How wrong a velocity was that led from the last pose to another than was found. Along a
  // corridor the scan says nothing of it.
  const auto believed = [&](const Velocity2& error) {
    return refined.weak ? Velocity2{0.0, 0.0, error.theta} : error;
  };
  // Encoders count steps, so over times as short as these they tell one velocity of the sweep and
  // another of the way between two scans.
  const Pose2 map_from_swept =
      map_from_last * Move(model.sweep_velocity + alignment.sweep_correction, prediction.dt);
  const Velocity2 of_sweep = believed(VelocityOverSweep(
      map_from_swept.Inverse() * refined.map_from_base, prediction.dt, alignment.points));
  alignment.edge_correction = alignment.sweep_correction;
  if (MattersForSweep(of_sweep, alignment.points)) {
    alignment.points = CorrectSweep(std::move(alignment.points), of_sweep);
    standing = Standing(alignment.points, refined.map_from_base);
    alignment.sweep_correction = alignment.sweep_correction + of_sweep;
    refined = refine_from(refined.map_from_base);
  }
  const Velocity2 of_motion =
      believed(VelocityOf(map_from_predicted.Inverse() * refined.map_from_base, prediction.dt));
  alignment.edge_correction = alignment.edge_correction + of_motion;
  alignment.standing = static_cast<int>(standing.size());
  return alignment;
}

MatchOutcome LocalMapMatcher::Match(const FusedModel& model, const Pose2& map_from_last,
                                    const MotionPrediction& prediction) {
  const Pose2 map_from_predicted = map_from_last * prediction.motion;
  const Alignment alignment = Align(model, map_from_last, prediction);
  const Refinement& refined = alignment.refined;
  MatchOutcome outcome;
  outcome.sweep_correction = alignment.sweep_correction;
  outcome.edge_correction = alignment.edge_correction;
  outcome.e = alignment.found.e;
  outcome.rms = refined.rms;
  outcome.candidates = alignment.found.candidates;
  outcome.points = alignment.standing;
  outcome.matched = refined.matched;
  if (prediction.blind && !alignment.ShowsAtLeast(kMost) && ++blind_ <= kMaxUnmatched) {
    outcome.too_few_points = outcome.undecided = true;
    outcome.covariance =
        TransportCovariance(filter_.PoseCovariance(), prediction.motion) + prediction.covariance;
    return outcome;
  }
  blind_ = 0;
  // Nothing was seen to stand in a longer time, least of all while a clock was set.
  constexpr double kLongest = 1.0;  // [s]
  time_ += std::min(prediction.dt, kLongest);

  outcome.edges = Filter(alignment, CorrectSweep(model.edges, alignment.edge_correction),
                         map_from_last, prediction);
  const ArcCoordinates deviation =
      ToArcCoordinates(map_from_predicted.Inverse() * filter_.map_from_base());
  outcome.on_window_edge = !prediction.window.Contains(deviation);
  outcome.deviation = prediction.window.Clamp(deviation);
  outcome.covariance = filter_.PoseCovariance();
  outcome.degenerate = refined.degenerate && !EdgesHold();
  outcome.degenerate_direction = refined.degenerate_direction;
  way_ += (prediction.motion * FromArcCoordinates(outcome.deviation)).translation().norm();
  ForgetOldSurroundings();
  outcome.too_few_points = !alignment.ShowsAtLeast(options_.min_matched_fraction);
  unmatched_ = outcome.too_few_points ? unmatched_ + 1 : 0;
  const bool unknown_surroundings = local_map_.elements().empty() || unmatched_ > kMaxUnmatched;
  if (!outcome.on_window_edge && (!outcome.too_few_points || unknown_surroundings)) {
    unmatched_ = 0;
    InsertIfMoved(alignment.points, map_from_predicted * FromArcCoordinates(outcome.deviation));
  }
  return outcome;
}

/// True for a point on something small that has not stood there for a while.
bool LocalMapMatcher::MayWalk(const SurfacePoint& point,
                              const RigidTransform2& map_from_base) const {
  if (!point.detached) return false;
  const Eigen::Vector2d place = map_from_base * point.point;
  const SurfaceElement* element = local_map_.Nearest(place);
  const double far_off = options_.local_map.max_merge_offset;
  return element == nullptr || !element->stands || local_map_.Distance(place, far_off) >= far_off;
}

/// Without what may walk; at the start that may be all there is.
std::vector<SurfacePoint> LocalMapMatcher::Standing(std::vector<SurfacePoint> points,
                                                    const Pose2& map_from_base) const {
  if (time_ <= options_.local_map.still_time) return points;
  const RigidTransform2 transform(map_from_base);
  points.erase(std::remove_if(points.begin(), points.end(),
                              [&](const SurfacePoint& p) { return MayWalk(p, transform); }),
               points.end());
  return points;
}

/// Without the edges that may be on people: the laser sees their legs, the camera shoulders, too.
std::vector<ModelEdge> LocalMapMatcher::WithoutWalkers(std::vector<ModelEdge> edges,
                                                       const std::vector<SurfacePoint>& points,
                                                       const Pose2& map_from_base) const {
  constexpr double kHalfWidth = 0.35;  // of a body, from any point of its legs [m]
  if (edges.empty()) return edges;
  const RigidTransform2 transform(map_from_base);
  for (const SurfacePoint& p : points) {
    if (!MayWalk(p, transform)) continue;
    edges.erase(std::remove_if(edges.begin(), edges.end(),
                               [&](const ModelEdge& edge) {
                                 const Eigen::Vector2d ray = Direction(edge.bearing);
                                 const Eigen::Vector2d leg = p.point - edge.camera;
                                 const double ahead = ray.dot(leg);
                                 return std::abs(Across(ray).dot(leg)) < kHalfWidth &&
                                        ahead > 0.0 && ahead < edge.range + kHalfWidth;
                               }),
                edges.end());
  }
  return edges;
}

/// True if the camera has told not long ago where along the way the base is.
bool LocalMapMatcher::EdgesHold() const {
  constexpr double kReach = 0.5;  // [m]
  return way_at_edges_ && way_ - *way_at_edges_ <= kReach;
}

/// Puts together what encoders, scan and image tell. Returns what became of the edges.
std::vector<EdgeMatch> LocalMapMatcher::Filter(const Alignment& alignment,
                                               std::vector<ModelEdge> edges,
                                               const Pose2& map_from_last,
                                               const MotionPrediction& prediction) {
  const Refinement& scan = alignment.refined;
  // The kernel finds wheels that slip where the laser sees it; in a corridor the edges must.
  filter_.Predict(map_from_last, prediction, prediction.covariance / scan.prior_weight);
  if (was_degenerate_ && !scan.degenerate) filter_.Anchor();
  was_degenerate_ = scan.degenerate;
  filter_.AddScan(scan.linearised_at, scan.information, scan.gradient);
  std::vector<EdgeMatch> matches(edges.size());
  for (std::size_t i = 0; i < edges.size(); ++i) edges[i].id = static_cast<int>(i);
  edges = WithoutWalkers(std::move(edges), alignment.points, scan.map_from_base);
  const std::vector<ModelEdge> distinct = DistinctEdges(edges, options_.filter.edges);
  const std::vector<EdgeMatch> of_distinct =
      filter_.AddEdges(distinct, scan.weak ? prediction.window.half_distance : 0.0);
  if (CountMatched(of_distinct) > 0) way_at_edges_ = way_;
  for (std::size_t i = 0; i < distinct.size(); ++i) matches[distinct[i].id] = of_distinct[i];
  return matches;
}

void LocalMapMatcher::InsertIfMoved(const std::vector<SurfacePoint>& points,
                                    const Pose2& map_from_base) {
  const Pose2 moved = map_from_inserted_.Inverse() * map_from_base;
  if (inserted_ >= options_.insert_first && moved.translation().norm() < options_.insert_distance &&
      std::abs(moved.theta) < options_.insert_angle) {
    return;
  }
  local_map_.Insert(points, map_from_base, way_, time_);
  map_from_inserted_ = map_from_base;
  ++inserted_;
}

/// What lies a long way back is left to the mapper, which knows how far the pose may have drifted
/// since.
void LocalMapMatcher::ForgetOldSurroundings() {
  constexpr double kStep = 0.1;  // of the distance, between two clean-ups
  if (way_ - way_at_forgetting_ < kStep * options_.forget_distance) return;
  way_at_forgetting_ = way_;
  local_map_.ForgetBefore(way_ - options_.forget_distance);
}

}  // namespace scan_image_slam
