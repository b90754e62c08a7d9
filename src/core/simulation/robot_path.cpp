#include "scan_image_slam/core/simulation/robot_path.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace scan_image_slam {
namespace {

constexpr double kSharpest = 0.75 * M_PI;  // turned on the spot beyond this [rad]
constexpr double kCurveReserve = 0.9;      // of the turn rate; the rest is for corrections

/// Part of a leg: straight on to a point, or around a corner.
struct Piece {
  double length;
  double curvature;
};

double HeadingOf(const Eigen::Vector2d& direction) {
  return std::atan2(direction.y(), direction.x());
}

class LegBuilder {
 public:
  LegBuilder(const RobotPath& path, const Eigen::Vector2d& start, double heading)
      : path_(path), pose_{start.x(), start.y(), heading} {
    leg_.start_heading = heading;
    Append();
  }

  void Straight(double length) { Advance({length, 0.0}); }
  void Corner(double radius, double angle) {
    Advance({radius * std::abs(angle), std::copysign(1.0 / radius, angle)});
  }

  PathLeg Finish() {
    leg_.end_direction = {std::cos(pose_.theta), std::sin(pose_.theta)};
    leg_.speeds.back() = 0.0;
    for (std::size_t i = leg_.speeds.size() - 1; i-- > 0;) {
      const double braking = std::sqrt(leg_.speeds[i + 1] * leg_.speeds[i + 1] +
                                       2.0 * path_.acceleration * PathLeg::kStep);
      leg_.speeds[i] = std::min(leg_.speeds[i], braking);
    }
    return leg_;
  }

 private:
  void Advance(const Piece& piece) {
    const double turn_limit =
        kCurveReserve * path_.turn_rate / std::max(std::abs(piece.curvature), 1e-9);
    limit_ = std::min(path_.speed, turn_limit);
    double left = piece.length;
    while (left > 0.0) {
      const double step = std::min(left, until_next_);
      pose_ = pose_ * Arc(step, step * piece.curvature);
      left -= step;
      until_next_ -= step;
      if (until_next_ <= 1e-12) Append();
    }
  }

  void Append() {
    leg_.points.push_back(pose_.translation());
    leg_.speeds.push_back(limit_);
    until_next_ = PathLeg::kStep;
  }

  RobotPath path_;
  Pose2 pose_;
  PathLeg leg_;
  double limit_ = path_.speed;
  double until_next_ = PathLeg::kStep;
};

}  // namespace

std::vector<PathLeg> MakeLegs(const RobotPath& path) {
  std::vector<Eigen::Vector2d> points = {path.start.translation()};
  points.insert(points.end(), path.way_points.begin(), path.way_points.end());
  std::vector<PathLeg> legs;
  if (points.size() < 2) return legs;

  const auto side = [&](std::size_t i) -> Eigen::Vector2d { return points[i + 1] - points[i]; };
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    if (side(i).norm() < 0.05) throw std::invalid_argument("two way points are at the same place");
  }
  LegBuilder builder(path, points[0], HeadingOf(side(0)));
  double done = 0.0;  // of the present side, used up by the corner before it
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const double length = side(i).norm();
    if (i + 2 == points.size()) {
      builder.Straight(length - done);
      break;
    }
    const double heading = HeadingOf(side(i + 1));
    const double angle = NormalizeAngle(heading - HeadingOf(side(i)));
    const double tangent = std::tan(std::min(std::abs(angle), kSharpest) / 2.0);
    const double radius = std::min(
        path.corner_radius, 0.5 * std::min(length, side(i + 1).norm()) / std::max(tangent, 1e-9));
    if (std::abs(angle) > kSharpest || radius <= 0.0) {
      builder.Straight(length - done);
      legs.push_back(builder.Finish());
      builder = LegBuilder(path, points[i + 1], heading);
      done = 0.0;
      continue;
    }
    builder.Straight(length - done - radius * tangent);
    if (std::abs(angle) > 1e-9) builder.Corner(radius, angle);
    done = radius * tangent;
  }
  legs.push_back(builder.Finish());
  return legs;
}

}  // namespace scan_image_slam
