#include "scan_image_slam/core/matching/frame_matcher.h"

#include "scan_image_slam/core/matching/nearest_field.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace scan_image_slam {
namespace {

struct WeightedPoint {
  Eigen::Vector2d point;
  double weight;  ///< 1, or more where an edge is seen [-]
};

/// The hits of a model within `field_of_view` around the robot's front, selected by angle.
std::vector<WeightedPoint> FrontalPart(const FusedModel& model, double field_of_view,
                                       double edge_gain) {
  std::vector<WeightedPoint> part;
  for (const ModelBeam& beam : model.beams) {
    const double heading = NormalizeAngle(model.HeadingOf(beam));
    if (!beam.hit() || 2.0 * std::abs(heading) > field_of_view) continue;
    part.push_back({beam.point, 1.0 + edge_gain * beam.edge_weight});
  }
  return part;
}

/// Distance from a place to the nearest point of a model, whose points follow each other by angle.
class ModelDistance {
 public:
  ModelDistance(std::vector<WeightedPoint> points, double max_distance)
      : points_(std::move(points)),
        max_distance_(max_distance),
        field_(max_distance / 5.0, max_distance) {
    for (std::size_t i = 0; i < points_.size(); ++i) {
      field_.Insert(static_cast<int>(i), points_[i].point);
    }
  }

  double operator()(const Eigen::Vector2d& place) const {
    constexpr int kNeighbours = 2;  // the field is only exact at the centres of its cells
    const int nearest = field_.Nearest(place);
    if (nearest < 0) return max_distance_;
    double squared = max_distance_ * max_distance_;
    const int last = static_cast<int>(points_.size()) - 1;
    for (int i = std::max(0, nearest - kNeighbours); i <= std::min(last, nearest + kNeighbours);
         ++i) {
      squared = std::min(squared, (points_[i].point - place).squaredNorm());
    }
    return std::sqrt(squared);
  }

 private:
  std::vector<WeightedPoint> points_;
  double max_distance_;
  NearestField field_;
};

}  // namespace

MatchOutcome FrameMatcher::Match(const FusedModel& model, const MotionPrediction& prediction) {
  const std::vector<WeightedPoint> frontal =
      FrontalPart(previous_, options_.frontal_field_of_view, options_.edge_gain);
  const ModelDistance distance(FrontalPart(model, options_.field_of_view, options_.edge_gain),
                               options_.max_distance);
  double weights = 0.0;
  for (const WeightedPoint& p : frontal) weights += p.weight;
  weights = std::max(weights, 1e-9);

  // Eq. 2-4: where a point of the previous model must be seen now, had the robot moved so.
  const auto sum_over_points = [&](const ArcCoordinates& deviation, auto&& value, double limit) {
    const RigidTransform2 now_from_previous(
        (prediction.motion * FromArcCoordinates(deviation)).Inverse());
    double sum = 0.0;
    for (const WeightedPoint& p : frontal) {
      sum += p.weight * value(distance(now_from_previous * p.point));
      if (sum >= limit) break;
    }
    return sum;
  };
  const auto identity = [](double d) { return d; };
  const SearchResult found =
      SearchExhaustively(MakeCandidates(prediction.window, options_.grid, false), prediction.window,
                         options_.grid, [&](const ArcCoordinates& deviation, double limit) {
                           return sum_over_points(deviation, identity, limit * weights) / weights;
                         });

  MatchOutcome outcome;
  outcome.deviation = found.deviation;
  outcome.e = found.e;
  outcome.rms = found.e;
  outcome.candidates = found.candidates;
  outcome.points = static_cast<int>(frontal.size());
  outcome.on_window_edge = found.on_window_edge;
  previous_ = model;
  return outcome;
}

}  // namespace scan_image_slam
