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

/// What one point says of the wall.
SurfaceElement ElementFrom(const SurfacePoint& point, const Eigen::Vector2d& place,
                           const Eigen::Vector2d& normal, const RangeNoise& noise) {
  SurfaceElement element;
  element.position = place.cast<float>();
  element.normal = normal.cast<float>();
  element.information = static_cast<float>(
      1.0 / (kMinVariance + noise.VarianceAcross(point.range, point.normal.dot(point.ray))));
  element.angle_information = static_cast<float>(1.0 / point.angle_variance);
  return element;
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
  if (!(std::abs(min_normal_cosine) <= 1.0)) {
    throw std::invalid_argument("min_normal_cosine must be between -1 and 1");
  }
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
    int id = ElementOf(place, normal);
    if (id >= 0) {
      Merge(id, point, place, normal);
    } else {
      const SurfaceElement* nearest = Nearest(place);
      const double too_near = 0.7 * options_.spacing;
      if (nearest != nullptr && (nearest->position.cast<double>() - place).norm() < too_near) {
        continue;
      }
      id = static_cast<int>(elements_.size());
      elements_.push_back(ElementFrom(point, place, normal, noise_));
      field_.Insert(id, place);
    }
    elements_[id].last_seen = static_cast<float>(way);
  }
}

/// The element of the wall that a point lies on, or -1. Cells answer for their centres, so those
/// beside are asked, too; of several elements it is the nearest along the wall, whatever the noise
/// across it, so that one wall does not become two.
int LocalMap::ElementOf(const Eigen::Vector2d& place, const Eigen::Vector2d& normal) const {
  const Eigen::Vector2d across = options_.spacing * normal;
  const Eigen::Vector2d along(-across.y(), across.x());
  int found = -1;
  double least = options_.spacing;
  for (const Eigen::Vector2d& seen :
       {place, Eigen::Vector2d(place + along), Eigen::Vector2d(place - along),
        Eigen::Vector2d(place + across), Eigen::Vector2d(place - across)}) {
    const int id = field_.Nearest(seen);
    if (id < 0) continue;
    const Eigen::Vector2d element_normal = elements_[id].normal.cast<double>();
    const Eigen::Vector2d offset = place - elements_[id].position.cast<double>();
    if (element_normal.dot(normal) <= options_.min_normal_cosine ||
        std::abs(element_normal.dot(offset)) >= options_.max_merge_offset ||
        Along(element_normal, offset) >= least) {
      continue;
    }
    least = Along(element_normal, offset);
    found = id;
  }
  return found;
}

/// Refines an element by a point that belongs to it.
void LocalMap::Merge(int id, const SurfacePoint& point, const Eigen::Vector2d& place,
                     const Eigen::Vector2d& normal) {
  SurfaceElement& element = elements_[id];
  const SurfaceElement seen = ElementFrom(point, place, normal, noise_);
  const Eigen::Vector2d element_normal = element.normal.cast<double>();
  const double across = element_normal.dot(place - element.position.cast<double>());
  const double gain = seen.information / (seen.information + element.information);
  element.position += (gain * across * element_normal).cast<float>();
  element.information += seen.information;

  const double angle_gain =
      seen.angle_information / (seen.angle_information + element.angle_information);
  element.normal =
      ((1.0 - angle_gain) * element_normal + angle_gain * normal).normalized().cast<float>();
  element.angle_information += seen.angle_information;
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
