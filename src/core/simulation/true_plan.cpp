#include "scan_image_slam/core/simulation/true_plan.h"

#include "scan_image_slam/core/simulation/laser_simulator.h"

#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace scan_image_slam {
namespace {

/// The mean of the points in each square of a grid that lies a little aside of round numbers, where
/// walls like to be.
class SquareMeans {
 public:
  explicit SquareMeans(double side) : side_(side) {}

  void Add(const Eigen::Vector2d& point) {
    Sum& sum = sums_[{Index(point.x()), Index(point.y())}];
    sum.points += point;
    ++sum.count;
  }

  std::vector<Eigen::Vector2d> Means() const {
    std::vector<Eigen::Vector2d> means;
    for (const auto& [square, sum] : sums_) means.emplace_back(sum.points / sum.count);
    return means;
  }

 private:
  struct Sum {
    Eigen::Vector2d points{0, 0};
    int count = 0;
  };
  double Index(double x) const { return std::floor(x / side_ + 0.013); }

  double side_;
  std::map<std::pair<double, double>, Sum> sums_;
};

bool ComesBack(const LaserHit& hit, const World& world, const LaserSimulatorOptions& laser) {
  if (hit.range < laser.range_min || hit.cosine < std::cos(laser.grazing_drop_angle)) return false;
  const LaserReturn kind = world.walls[hit.surface].laser;
  if (kind == LaserReturn::kDark) return hit.range <= laser.dark_range;
  return kind != LaserReturn::kGlass || hit.cosine >= std::cos(laser.glass_angle);
}

}  // namespace

TruePlan SeenPlan(World world, const LaserSimulatorOptions& laser,
                  const std::vector<Pose2>& world_from_base, double cell) {
  world.people.clear();
  LaserSimulatorOptions narrow = laser;
  narrow.mixed_pixels = false;  // one ray per beam
  const LaserCaster caster(world, laser.mount.z);
  std::set<int> met;
  SquareMeans seen(cell);
  for (const Pose2& pose : world_from_base) {
    MotionHistory standing(0.0);
    standing.Add({0, pose, 0.0, 0.0});
    const LaserFan fan = MakeFan(narrow, standing, 0, 0);
    const LaserHits hits = caster.Cast(fan);
    for (std::size_t i = 0; i < fan.rays.size(); ++i) {
      const auto add = [&](const LaserHit& hit) {
        if (!(hit.range <= laser.range_max)) return;
        met.insert(hit.surface);
        if (!ComesBack(hit, world, laser)) return;
        seen.Add(fan.rays[i].origin + hit.range * fan.rays[i].direction);
      };
      const bool glass_first = hits.glass[i].range < hits.solid[i].range;
      if (glass_first) add(hits.glass[i]);
      add(hits.solid[i]);
    }
  }
  TruePlan plan;
  for (const int wall : met) plan.walls.push_back({world.walls[wall].from, world.walls[wall].to});
  plan.seen = seen.Means();
  return plan;
}

}  // namespace scan_image_slam
