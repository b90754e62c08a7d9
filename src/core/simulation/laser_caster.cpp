#include "scan_image_slam/core/simulation/laser_caster.h"

#include "scan_image_slam/core/geometry/pose2.h"

#include <algorithm>
#include <cmath>

namespace scan_image_slam {
namespace {

struct BeamRange {
  std::size_t begin;
  std::size_t end;
};

/// Finds the beams of a fan that can hit something.
class FanIndex {
 public:
  explicit FanIndex(const LaserFan& fan) : fan_(fan) {
    const std::vector<double>& bearings = fan.bearings;
    sign_ = bearings.back() >= bearings.front() ? 1.0 : -1.0;
    for (const double bearing : bearings) keys_.push_back(sign_ * bearing);
    const double step = (keys_.back() - keys_.front()) / std::max<double>(1.0, keys_.size() - 1.0);
    slack_ = fan.half_width + step;
    middle_ = Origin(fan.beams() / 2);
    for (const std::size_t beam : {std::size_t{0}, fan.beams() - 1}) {
      travel_ = std::max(travel_, (Origin(beam) - middle_).norm());
    }
  }

  /// Beams towards a disc around `centre`.
  std::vector<BeamRange> Towards(const Eigen::Vector2d& centre, double radius) const {
    const Eigen::Vector2d way = centre - middle_;
    const double bearing = std::atan2(way.y(), way.x());
    const double spread = AngleOf(radius, way.norm()) + AngleOf(travel_, way.norm());
    return Between(bearing - spread, bearing + spread);
  }

  /// Beams towards a segment.
  std::vector<BeamRange> Towards(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const {
    const Eigen::Vector2d a = from - middle_;
    const Eigen::Vector2d b = to - middle_;
    const double bearing = std::atan2(a.y(), a.x());
    const double turn = std::atan2(Cross(a, b), a.dot(b));
    const double slack = std::max(AngleOf(travel_, a.norm()), AngleOf(travel_, b.norm()));
    // Almost through the laser: it may see the wall from the other side within the same sweep.
    const double distance = std::abs(Cross(a, b)) / std::max((b - a).norm(), 1e-12);
    if (distance <= travel_ + 1e-6 && std::abs(turn) > M_PI_2) return Between(-M_PI, M_PI);
    return Between(bearing + std::min(turn, 0.0) - slack, bearing + std::max(turn, 0.0) + slack);
  }

 private:
  Eigen::Vector2d Origin(std::size_t beam) const {
    return fan_.rays[beam * fan_.rays_per_beam].origin;
  }

  static double AngleOf(double offset, double distance) {
    return offset < distance ? std::asin(offset / distance) : M_PI;
  }

  std::vector<BeamRange> Between(double low, double high) const {
    double begin = (sign_ > 0.0 ? low : -high) - slack_;
    double end = (sign_ > 0.0 ? high : -low) + slack_;
    if (end - begin >= 2.0 * M_PI) return {{0, keys_.size()}};
    const double turns = std::floor((end - keys_.front()) / (2.0 * M_PI));
    begin -= turns * 2.0 * M_PI;  // now end is the first one beyond the fan's beginning
    end -= turns * 2.0 * M_PI;
    std::vector<BeamRange> ranges;
    for (; begin <= keys_.back(); begin += 2.0 * M_PI, end += 2.0 * M_PI) {
      const auto first = std::lower_bound(keys_.begin(), keys_.end(), begin);
      const auto last = std::upper_bound(first, keys_.end(), end);
      if (first != last) {
        ranges.push_back({static_cast<std::size_t>(first - keys_.begin()),
                          static_cast<std::size_t>(last - keys_.begin())});
      }
    }
    return ranges;
  }

  const LaserFan& fan_;
  double sign_ = 1.0;
  double slack_ = 0.0;
  double travel_ = 0.0;
  Eigen::Vector2d middle_{0, 0};
  std::vector<double> keys_;
};

/// Nearer of the ray's two intersections with a circle.
void HitCircle(const LaserRay& ray, const Eigen::Vector2d& centre, double radius, int surface,
               LaserHit& best) {
  const Eigen::Vector2d way = centre - ray.origin;
  const double along = way.dot(ray.direction);
  const double half2 = radius * radius - (way.squaredNorm() - along * along);
  if (half2 <= 0.0) return;
  const double range = along - std::sqrt(half2);
  if (range <= 0.0 || range >= best.range) return;
  best = {range, std::sqrt(half2) / radius, surface};
}

void CastLegs(const Person& person, int surface, const LaserFan& fan, const FanIndex& index,
              std::vector<LaserHit>& hits) {
  // Legs move by a few centimetres during a sweep; between its ends they move evenly.
  const double begin = fan.times.front();
  const double duration = std::max(fan.times.back() - begin, 1e-9);
  const Posture first = PostureAt(person, begin);
  const Posture last = PostureAt(person, begin + duration);
  const double reach = kPersonRadius + (last.position - first.position).norm();
  for (const BeamRange& range : index.Towards(first.position, reach)) {
    for (std::size_t beam = range.begin; beam < range.end; ++beam) {
      const double f = (fan.times[beam] - begin) / duration;
      for (std::size_t leg = 0; leg < first.legs.size(); ++leg) {
        const Eigen::Vector2d centre = first.legs[leg] + f * (last.legs[leg] - first.legs[leg]);
        for (int i = 0; i < fan.rays_per_beam; ++i) {
          const std::size_t ray = beam * fan.rays_per_beam + i;
          HitCircle(fan.rays[ray], centre, person.leg_radius, surface, hits[ray]);
        }
      }
    }
  }
}

}  // namespace

LaserCaster::LaserCaster(const World& world, double height) : world_(world) {
  for (std::size_t i = 0; i < world.walls.size(); ++i) {
    const Wall& wall = world.walls[i];
    const Eigen::Vector2d edge = wall.to - wall.from;
    const bool there = wall.bottom <= height && height < wall.top && edge.norm() > 0.0;
    if (!there || wall.laser == LaserReturn::kInvisible) continue;
    targets_.push_back({wall.from, edge, Eigen::Vector2d(-edge.y(), edge.x()).normalized(),
                        static_cast<int>(i), wall.laser == LaserReturn::kGlass});
  }
}

LaserHits LaserCaster::Cast(const LaserFan& fan) const {
  LaserHits hits;
  hits.solid.resize(fan.rays.size());
  hits.glass.resize(fan.rays.size());
  const FanIndex index(fan);
  for (const Target& target : targets_) {
    std::vector<LaserHit>& best = target.glass ? hits.glass : hits.solid;
    for (const BeamRange& range : index.Towards(target.from, target.from + target.edge)) {
      for (std::size_t i = range.begin * fan.rays_per_beam; i < range.end * fan.rays_per_beam;
           ++i) {
        // origin + r direction = from + s edge
        const LaserRay& ray = fan.rays[i];
        const Eigen::Vector2d way = target.from - ray.origin;
        const double slant = Cross(ray.direction, target.edge);
        const double r = Cross(way, target.edge) / slant;
        const double s = Cross(way, ray.direction) / slant;
        if (!(r > 0.0 && r < best[i].range && s >= 0.0 && s <= 1.0)) continue;  // also if parallel
        best[i] = {r, std::abs(ray.direction.dot(target.normal)), target.wall};
      }
    }
  }
  for (std::size_t n = 0; n < world_.people.size(); ++n) {
    CastLegs(world_.people[n], -2 - static_cast<int>(n), fan, index, hits.solid);
  }
  return hits;
}

}  // namespace scan_image_slam
