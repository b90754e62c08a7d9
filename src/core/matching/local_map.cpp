#include "scan_image_slam/core/matching/local_map.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace scan_image_slam {
namespace {

/// A measured line is never known better than this across the wall [m^2].
constexpr double kMinVariance = 1e-6;

/// Distance along the wall, given its normal.
double Along(const Eigen::Vector2d& normal, const Eigen::Vector2d& offset) {
  return std::abs(normal.x() * offset.y() - normal.y() * offset.x());
}

}  // namespace

void LocalMapOptions::Validate() const {
  const auto require = [](double value, const char* name) {
    if (!(std::isfinite(value) && value > 0.0)) {
      throw std::invalid_argument(std::string(name) + " must be positive and finite");
    }
  };
  require(spacing, "spacing");
  require(reach, "reach");
  require(max_merge_offset, "max_merge_offset");
}

LocalMap::LocalMap(const LocalMapOptions& options, const RangeNoise& noise)
    : options_(options), noise_(noise), field_(options.spacing, options.reach) {
  options_.Validate();
}

void LocalMap::Insert(const std::vector<SurfacePoint>& points, const Pose2& map_from_base,
                      double way) {
  const RigidTransform2 transform(map_from_base);
  for (const SurfacePoint& point : points) {
    if (!point.has_normal()) continue;
    const Eigen::Vector2d place = transform * point.point;
    const Eigen::Vector2d normal = transform.Rotate(point.normal);
    if (Merge(point, place, normal, way)) continue;
    SurfaceElement element;
    element.position = place.cast<float>();
    element.normal = normal.cast<float>();
    element.information = static_cast<float>(
        1.0 / (kMinVariance + noise_.VarianceAcross(point.range, point.normal.dot(point.ray))));
    element.angle_information = static_cast<float>(1.0 / point.angle_variance);
    element.last_seen = static_cast<float>(way);
    field_.Insert(static_cast<int>(elements_.size()), place);
    elements_.push_back(element);
  }
}

/// Refines the element that a point belongs to. False if there is none: the point starts one.
bool LocalMap::Merge(const SurfacePoint& point, const Eigen::Vector2d& place,
                     const Eigen::Vector2d& normal, double way) {
  const int id = field_.Nearest(place);
  if (id < 0) return false;
  SurfaceElement& element = elements_[id];
  const Eigen::Vector2d element_normal = element.normal.cast<double>();
  const Eigen::Vector2d offset = place - element.position.cast<double>();
  const double across = element_normal.dot(offset);
  const bool belongs = element_normal.dot(normal) > options_.min_normal_cosine &&
                       Along(element_normal, offset) < options_.spacing &&
                       std::abs(across) < options_.max_merge_offset;
  if (!belongs) return offset.norm() < 0.7 * options_.spacing;  // too near to start another one

  const double cosine = point.normal.dot(point.ray);
  const double information = 1.0 / (kMinVariance + noise_.VarianceAcross(point.range, cosine));
  const double gain = information / (information + element.information);
  element.position += (gain * across * element_normal).cast<float>();
  element.information += static_cast<float>(information);

  const double angle_information = 1.0 / point.angle_variance;
  const double angle_gain = angle_information / (angle_information + element.angle_information);
  element.normal =
      ((1.0 - angle_gain) * element_normal + angle_gain * normal).normalized().cast<float>();
  element.angle_information += static_cast<float>(angle_information);
  element.last_seen = static_cast<float>(way);
  return true;
}

double LocalMap::Distance(const Eigen::Vector2d& place, double max_distance) const {
  const SurfaceElement* element = Nearest(place);
  if (element == nullptr) return max_distance;
  const Eigen::Vector2d normal = element->normal.cast<double>();
  const Eigen::Vector2d offset = place - element->position.cast<double>();
  const double across = normal.dot(offset);
  const double along = std::max(0.0, Along(normal, offset) - 0.5 * options_.spacing);
  return std::min(max_distance, std::sqrt(across * across + along * along));
}

void LocalMap::ForgetBefore(double way) {
  const auto forgotten = std::remove_if(elements_.begin(), elements_.end(),
                                        [&](const auto& e) { return e.last_seen < way; });
  if (forgotten == elements_.end()) return;
  elements_.erase(forgotten, elements_.end());
  field_.Clear();
  for (std::size_t i = 0; i < elements_.size(); ++i) {
    field_.Insert(static_cast<int>(i), elements_[i].position.cast<double>());
  }
}

void LocalMap::Clear() {
  elements_.clear();
  field_.Clear();
}

}  // namespace scan_image_slam
