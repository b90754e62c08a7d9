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
  return std::abs(Cross(normal, offset));
}

/// The points that have a normal, in the map.
std::vector<SurfacePoint> WithNormals(const std::vector<SurfacePoint>& points,
                                      const Pose2& map_from_base) {
  const RigidTransform2 transform(map_from_base);
  std::vector<SurfacePoint> placed;
  placed.reserve(points.size());
  for (SurfacePoint p : points) {
    if (!p.has_normal()) continue;
    p.point = transform * p.point;
    p.ray = transform.Rotate(p.ray);
    p.normal = transform.Rotate(p.normal);
    placed.push_back(p);
  }
  return placed;
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
  require(still_time, "still_time");
  if (!(std::abs(min_normal_cosine) <= 1.0)) {
    throw std::invalid_argument("min_normal_cosine must be between -1 and 1");
  }
}

LocalMap::LocalMap(const LocalMapOptions& options, const RangeNoise& noise)
    : options_(options), noise_(noise), field_(options.spacing, options.reach) {
  options_.Validate();
}

void LocalMap::Insert(const std::vector<SurfacePoint>& points, const Pose2& map_from_base,
                      double way, double time) {
  ++insertion_;
  const std::vector<SurfacePoint> placed = WithNormals(points, map_from_base);
  for (const SurfacePoint& point : placed) Begin(point, time);
  for (const SurfacePoint& point : placed) {
    const int id = ElementOf(point);
    if (id < 0) continue;
    Merge(id, point);
    elements_[id].last_seen = static_cast<float>(way);
    Watch(id, time);
  }
}

/// Begins an element, of which nothing is known yet, if a point belongs to none. All elements of a
/// scan begin before points merge, so that each takes them from both sides. If the first one took
/// those ahead of it alone, it would be off by its normal's error times half the spacing, always to
/// the same side of the scan, and the heading would drift.
void LocalMap::Begin(const SurfacePoint& point, double time) {
  if (ElementOf(point) >= 0) return;
  const SurfaceElement* nearest = Nearest(point.point);
  const double too_near = 0.7 * options_.spacing;
  if (nearest != nullptr && (nearest->position.cast<double>() - point.point).norm() < too_near) {
    return;
  }
  SurfaceElement element;
  element.position = point.point.cast<float>();
  element.normal = point.normal.cast<float>();
  element.since = static_cast<float>(time);
  element.last_insertion = insertion_;
  field_.Insert(static_cast<int>(elements_.size()), point.point);
  elements_.push_back(element);
}

/// The element of the wall that a point lies on, or -1. Cells answer for their centres, so those
/// beside are asked, too; of several elements it is the nearest along the wall, whatever the noise
/// across it, so that one wall does not become two.
int LocalMap::ElementOf(const SurfacePoint& point) const {
  const Eigen::Vector2d& place = point.point;
  const Eigen::Vector2d across = options_.spacing * point.normal;
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
    if (element_normal.dot(point.normal) <= options_.min_normal_cosine ||
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
void LocalMap::Merge(int id, const SurfacePoint& point) {
  SurfaceElement& element = elements_[id];
  const Eigen::Vector2d normal = element.normal.cast<double>();
  const double across = normal.dot(point.point - element.position.cast<double>());
  const auto information = static_cast<float>(
      1.0 / (kMinVariance + noise_.VarianceAcross(point.range, point.normal.dot(point.ray))));
  element.information += information;
  element.position += (information / element.information * across * normal).cast<float>();

  const auto angle_information = static_cast<float>(1.0 / point.angle_variance);
  element.angle_information += angle_information;
  const double gain = angle_information / element.angle_information;
  element.normal = ((1.0 - gain) * normal + gain * point.normal).normalized().cast<float>();
}

/// Once an element has stood, it stays: what is hidden or out of view for a while is there still.
void LocalMap::Watch(int id, double time) {
  constexpr int kBreak = 3;  // scans in a row that don't hit it
  SurfaceElement& element = elements_[id];
  if (element.last_insertion < insertion_ - kBreak) element.since = static_cast<float>(time);
  element.last_insertion = insertion_;
  if (time - element.since >= options_.still_time) element.stands = true;
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
  insertion_ = 0;
}

}  // namespace scan_image_slam
