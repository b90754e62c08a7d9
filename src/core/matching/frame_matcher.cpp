#include "scan_image_slam/core/matching/frame_matcher.h"

#include "scan_image_slam/core/matching/nearest_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

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

/// The two models of eq. 4, and how well they fit.
class ModelPair {
 public:
  ModelPair(std::vector<WeightedPoint> previous, std::vector<WeightedPoint> current,
            const Pose2& predicted_motion, double max_distance)
      : previous_(std::move(previous)),
        distance_(std::move(current), max_distance),
        predicted_motion_(predicted_motion) {
    for (const WeightedPoint& p : previous_) weights_ += p.weight;
  }

  /// Weighted mean of `cost(distance)`; eq. 2 and 3 say where a point of the previous model is seen
  /// from the new place. Gives up, with a value not below it, when `limit` is reached.
  template <typename Cost>
  double Mean(const ArcCoordinates& deviation, double limit, const Cost& cost) const {
    const RigidTransform2 now_from_previous(
        (predicted_motion_ * FromArcCoordinates(deviation)).Inverse());
    double sum = 0.0;
    for (const WeightedPoint& p : previous_) {
      sum += p.weight * cost(distance_(now_from_previous * p.point));
      if (sum >= limit * weights_) break;
    }
    return weights_ > 0.0 ? sum / weights_ : 0.0;
  }

  int Matched(const ArcCoordinates& deviation, double max_distance) const {
    const RigidTransform2 now_from_previous(
        (predicted_motion_ * FromArcCoordinates(deviation)).Inverse());
    return static_cast<int>(
        std::count_if(previous_.begin(), previous_.end(), [&](const WeightedPoint& p) {
          return distance_(now_from_previous * p.point) < max_distance;
        }));
  }

  int size() const { return static_cast<int>(previous_.size()); }

 private:
  std::vector<WeightedPoint> previous_;
  ModelDistance distance_;
  Pose2 predicted_motion_;
  double weights_ = 0.0;
};

/// Covariance of the motion from the curvature of the squared distances around the optimum, beside
/// what the prediction says: it grows in a direction in which the cost is flat.
Eigen::Matrix3d CovarianceAround(const ModelPair& pair, const ArcCoordinates& optimum,
                                 const MotionPrediction& prediction,
                                 const FrameMatcherOptions& options) {
  const double steps[] = {4.0 * options.grid.distance_step, 4.0 * options.grid.angle_step};
  const auto cost = [&](double distance, double angle) {
    constexpr double kNoLimit = std::numeric_limits<double>::infinity();
    return pair.size() *
           pair.Mean({optimum.distance + distance, optimum.lateral, optimum.angle + angle},
                     kNoLimit, [](double d) { return d * d; });
  };
  const double centre = cost(0, 0);
  const double dd = cost(steps[0], 0) - 2.0 * centre + cost(-steps[0], 0);
  const double aa = cost(0, steps[1]) - 2.0 * centre + cost(0, -steps[1]);
  const double da = 0.25 * (cost(steps[0], steps[1]) - cost(steps[0], -steps[1]) -
                            cost(-steps[0], steps[1]) + cost(-steps[0], -steps[1]));
  const double scale = 1.0 / (2.0 * options.range_stddev * options.range_stddev);
  Eigen::Matrix3d information = prediction.covariance.inverse();
  // Off the optimum the cost may be hollow; only what it adds to the prediction counts.
  const double distance_information = std::max(0.0, dd) * scale / (steps[0] * steps[0]);
  const double angle_information = std::max(0.0, aa) * scale / (steps[1] * steps[1]);
  const double limit = 0.99 * std::sqrt(distance_information * angle_information);
  const double mixed = std::clamp(da * scale / (steps[0] * steps[1]), -limit, limit);
  information(0, 0) += distance_information;
  information(2, 2) += angle_information;
  information(0, 2) += mixed;
  information(2, 0) += mixed;
  return information.inverse();
}

}  // namespace

MatchOutcome FrameMatcher::Match(const FusedModel& model, const MotionPrediction& prediction) {
  const ModelPair pair(FrontalPart(previous_, options_.frontal_field_of_view, options_.edge_gain),
                       FrontalPart(model, options_.field_of_view, options_.edge_gain),
                       prediction.motion, options_.max_distance);
  const SearchResult found = SearchExhaustively(
      MakeCandidates(prediction.window, options_.grid, false), prediction.window, options_.grid,
      [&](const ArcCoordinates& deviation, double limit) {
        return pair.Mean(deviation, limit, [](double distance) { return distance; });
      });
  previous_ = model;

  MatchOutcome outcome;
  outcome.deviation = found.deviation;
  outcome.covariance = CovarianceAround(pair, found.deviation, prediction, options_);
  outcome.e = found.e;
  outcome.rms = found.e;
  outcome.candidates = found.candidates;
  outcome.points = pair.size();
  outcome.matched = pair.Matched(found.deviation, options_.max_distance);
  outcome.on_window_edge = found.on_window_edge;
  outcome.too_few_points = outcome.matched == 0;
  return outcome;
}

}  // namespace scan_image_slam
