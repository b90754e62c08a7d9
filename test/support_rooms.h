#pragma once

#include "scan_image_slam/core/fusion/fused_model.h"
#include "scan_image_slam/core/geometry/pose2.h"
#include "scan_image_slam/core/sensor/laser_scan.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include <Eigen/Core>

namespace scan_image_slam {

/// Random numbers for tests: the same with every standard library, as the engine is and the
/// distributions of <random> are not.
class TestRandom {
 public:
  explicit TestRandom(std::uint64_t seed) : engine_(seed) {}

  /// In [low, high).
  double Uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }
  /// Mean 0, standard deviation 1 (Box and Muller 1958).
  double Normal() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - Uniform(0.0, 1.0)));
    return radius * std::cos(Uniform(0.0, 2.0 * M_PI));
  }
  int Index(int count) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(count)); }

 private:
  std::mt19937_64 engine_;
};

/// A room is walls seen from above, in the frame `room` [m].
struct RoomWall {
  Eigen::Vector2d from;
  Eigen::Vector2d to;
};
using Room = std::vector<RoomWall>;

/// The four walls of a rectangle.
inline Room Rectangle(double min_x, double min_y, double max_x, double max_y) {
  const Eigen::Vector2d a(min_x, min_y), b(max_x, min_y), c(max_x, max_y), d(min_x, max_y);
  return {{a, b}, {b, c}, {c, d}, {d, a}};
}

inline Room operator+(Room a, const Room& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// A room in which every pose can be told: 8 m x 6 m, two boxes, and a slanted wall.
inline Room FurnishedRoom() {
  return Rectangle(-4.0, -3.0, 4.0, 3.0) + Rectangle(1.5, 1.0, 2.3, 1.6) +
         Rectangle(-2.6, -1.9, -1.8, -1.0) + Room{{{3.0, -3.0}, {4.0, -1.6}}};
}

/// Five walls around the origin that do not meet, so that no line fit spans a corner: what is
/// estimated from a scan without noise is exact.
inline Room SeparateWalls() {
  return {{{-1.5, 3.0}, {2.0, 3.0}},
          {{-2.0, -2.5}, {1.0, -2.5}},
          {{3.5, -1.0}, {3.5, 2.0}},
          {{-4.0, -1.2}, {-3.4, 1.5}},
          {{2.0, -3.0}, {3.0, -2.2}}};
}

/// Two walls along x, 2 m apart, beyond the reach of the laser at both ends.
inline Room PlainCorridor() { return {{{-60, 1}, {60, 1}}, {{-60, -1}, {60, -1}}}; }

/// Distance to the nearest wall along a ray, +Inf if there is none [m].
inline double CastRay(const Room& room, const Eigen::Vector2d& origin, double heading) {
  const Eigen::Vector2d ray(std::cos(heading), std::sin(heading));
  double nearest = std::numeric_limits<double>::infinity();
  for (const RoomWall& wall : room) {
    const Eigen::Vector2d along = wall.to - wall.from;
    const Eigen::Vector2d start = wall.from - origin;
    const double determinant = ray.x() * along.y() - ray.y() * along.x();
    if (std::abs(determinant) < 1e-12) continue;
    const double distance = (start.x() * along.y() - start.y() * along.x()) / determinant;
    const double fraction = (start.x() * ray.y() - start.y() * ray.x()) / determinant;
    if (distance > 0.0 && fraction >= 0.0 && fraction <= 1.0 && distance < nearest) {
      nearest = distance;
    }
  }
  return nearest;
}

/// A laser in the middle of the base and what it does during a sweep.
struct TestLaser {
  int beams = 720;
  double field_of_view = 2.0 * M_PI;  ///< around the front [rad]
  double max_range = 30.0;            ///< [m]
  double range_stddev = 0.0;          ///< [m]
  double time_increment = 0.0;        ///< [s]
  double first_beam_time = 0.0;       ///< since the stamp [s]
  Velocity2 velocity;                 ///< of the base while the laser turns
  Velocity2 assumed_velocity;         ///< that the points of the model are corrected with

  double Bearing(int beam) const { return field_of_view * ((beam + 0.5) / beams - 0.5); }
  double Time(int beam) const { return first_beam_time + beam * time_increment; }
};

/// Ranges from `room_from_base` at the first beam, with noise if there is a source of it.
inline LaserScan ScanOf(const Room& room, const Pose2& room_from_base, Stamp stamp,
                        const TestLaser& laser, TestRandom* random = nullptr) {
  LaserScan scan;
  scan.stamp = stamp;
  scan.angle_min = laser.Bearing(0);
  scan.angle_increment = laser.Bearing(1) - laser.Bearing(0);
  scan.time_increment = laser.time_increment;
  scan.range_min = 0.05;
  scan.range_max = laser.max_range;
  for (int i = 0; i < laser.beams; ++i) {
    const Pose2 pose = room_from_base * Move(laser.velocity, laser.Time(i));
    double range = CastRay(room, pose.translation(), pose.theta + laser.Bearing(i));
    if (random != nullptr) range += laser.range_stddev * random->Normal();
    if (range > laser.max_range) range = std::numeric_limits<double>::infinity();
    scan.ranges.push_back(static_cast<float>(range));
  }
  return scan;
}

/// The model of a scan as ScanOf makes it, in double precision.
inline FusedModel ModelOf(const Room& room, const Pose2& room_from_base, Stamp stamp,
                          const TestLaser& laser, TestRandom* random = nullptr) {
  FusedModel model;
  model.stamp = stamp;
  model.sweep_velocity = laser.assumed_velocity;
  for (int i = 0; i < laser.beams; ++i) {
    ModelBeam beam;
    beam.bearing = laser.Bearing(i);
    beam.time_offset = laser.Time(i);
    const Pose2 pose = room_from_base * Move(laser.velocity, beam.time_offset);
    beam.range = CastRay(room, pose.translation(), pose.theta + beam.bearing);
    if (random != nullptr) beam.range += laser.range_stddev * random->Normal();
    if (beam.range > laser.max_range) beam.range = std::numeric_limits<double>::infinity();
    if (beam.hit()) {
      beam.point =
          Move(laser.assumed_velocity, beam.time_offset) *
          Eigen::Vector2d(beam.range * std::cos(beam.bearing), beam.range * std::sin(beam.bearing));
    }
    model.beams.push_back(beam);
  }
  return model;
}

/// A vertical edge on a wall.
struct RoomEdge {
  Eigen::Vector2d position;  ///< [m]
  int sign = 1;
};

/// What a camera in the middle of the base, looking around, sees of the edges; none is hidden.
inline std::vector<ModelEdge> EdgesSeen(const std::vector<RoomEdge>& edges,
                                        const Pose2& room_from_base, double bearing_stddev) {
  std::vector<ModelEdge> seen;
  for (const RoomEdge& edge : edges) {
    const Eigen::Vector2d p = room_from_base.Inverse() * edge.position;
    ModelEdge e;
    e.bearing = std::atan2(p.y(), p.x());
    e.bearing_stddev = bearing_stddev;
    e.range = p.norm();
    e.range_stddev = 0.02;
    e.sign = edge.sign;
    e.weight = 1.0;
    e.contrast = 100.0;
    seen.push_back(e);
  }
  return seen;
}

}  // namespace scan_image_slam
