#include "scan_image_slam/core/simulation/person.h"

#include "scan_image_slam/core/simulation/furniture.h"
#include "scan_image_slam/core/simulation/world.h"

#include <algorithm>
#include <cmath>

namespace scan_image_slam {
namespace {

constexpr double kStride = 1.4;       // two steps at walking speed [m]
constexpr double kStep = 0.22;        // how far a foot swings from the middle [m]
constexpr double kLegSpacing = 0.11;  // from the middle to each leg [m]

double WrapTime(const Person& person, double time) {
  const double begin = person.path.front().time;
  const double period = person.path.back().time - begin;
  if (!person.loop || period <= 0.0 || time < begin) return time;
  return begin + std::fmod(time - begin, period);
}

struct Progress {
  Eigen::Vector2d position;
  Eigen::Vector2d velocity;
  double walked;  // since the beginning of the path [m]
};

Progress Walk(const Person& person, double time) {
  Progress progress{person.path.front().position, Eigen::Vector2d::Zero(), 0.0};
  if (time < person.path.front().time) return progress;
  for (std::size_t i = 0; i + 1 < person.path.size(); ++i) {
    const Person::WayPoint& a = person.path[i];
    const Person::WayPoint& b = person.path[i + 1];
    const double fraction = std::min((time - a.time) / (b.time - a.time), 1.0);
    const Eigen::Vector2d step = b.position - a.position;
    progress.position = a.position + fraction * step;
    progress.walked += fraction * step.norm();
    if (fraction < 1.0) {
      progress.velocity = step / (b.time - a.time);
      return progress;
    }
  }
  return progress;
}

/// Direction of the part of the path that is walked now, or was walked last.
double HeadingAt(const Person& person, double time) {
  Eigen::Vector2d direction = Eigen::Vector2d::UnitX();
  for (std::size_t i = 0; i + 1 < person.path.size(); ++i) {
    const Eigen::Vector2d step = person.path[i + 1].position - person.path[i].position;
    if (step.norm() > 1e-6) direction = step;
    if (time < person.path[i + 1].time) break;
  }
  return std::atan2(direction.y(), direction.x());
}

}  // namespace

Posture PostureAt(const Person& person, double time) {
  const double now = WrapTime(person, time);
  const Progress progress = Walk(person, now);
  Posture posture;
  posture.position = progress.position;
  posture.speed = progress.velocity.norm();
  posture.heading = HeadingAt(person, now);
  const Eigen::Vector2d ahead(std::cos(posture.heading), std::sin(posture.heading));
  const Eigen::Vector2d left(-ahead.y(), ahead.x());
  const double swing =
      posture.speed > 0.0 ? kStep * std::sin(2.0 * M_PI * progress.walked / kStride) : 0.0;
  posture.legs[0] = posture.position + kLegSpacing * left + swing * ahead;
  posture.legs[1] = posture.position - kLegSpacing * left - swing * ahead;
  return posture;
}

std::vector<Wall> BodyWalls(const Person& person, double time) {
  const Posture posture = PostureAt(person, time);
  std::vector<Wall> walls;
  const auto add = [&](const std::vector<Eigen::Vector2d>& outline, double bottom, double top,
                       int face) {
    Wall wall;
    wall.bottom = bottom * person.height;
    wall.top = top * person.height;
    wall.face = face;
    AppendPrism(outline, wall, walls);
  };
  for (const Eigen::Vector2d& leg : posture.legs) {
    add(CircleOutline(leg, person.leg_radius, 6), 0.0, 0.48, person.trousers);
  }
  const Placement body{posture.position, posture.heading};
  add(RectangleOutline(body, {0.24, 0.44}), 0.46, 0.83, person.shirt);
  add(RectangleOutline(body, {0.20, 0.17}), 0.86, 1.0, person.head);
  return walls;
}

}  // namespace scan_image_slam
