#pragma once

#include <cmath>

#include <Eigen/Core>

namespace scan_image_slam {

/// An angle as people read it [deg].
constexpr double Degrees(double radians) { return radians * 180.0 / M_PI; }

/// The same angle in (-pi, pi] [rad]; NaN if it is not finite.
double NormalizeAngle(double angle);

/// The unit vector at an angle.
inline Eigen::Vector2d Direction(double angle) { return {std::cos(angle), std::sin(angle)}; }

/// The area that two vectors span, positive if the second lies to the left of the first.
inline double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// The same vector turned by a quarter to the left.
inline Eigen::Vector2d Across(const Eigen::Vector2d& v) { return {-v.y(), v.x()}; }

/// Rigid motion in the plane, named target_from_source: maps points of `source` into `target`.
struct Pose2 {
  double x = 0.0;      ///< [m]
  double y = 0.0;      ///< [m]
  double theta = 0.0;  ///< [rad]

  Eigen::Vector2d translation() const { return {x, y}; }
  Eigen::Vector3d coordinates() const { return {x, y, theta}; }
  Pose2 Inverse() const;
};

/// True if none of its numbers is infinite or NaN.
bool IsFinite(const Pose2& pose);

/// Chains a_from_b * b_from_c = a_from_c; the angle of the result is in (-pi, pi].
Pose2 operator*(const Pose2& a_from_b, const Pose2& b_from_c);

/// Moves one point; for many points use RigidTransform2.
Eigen::Vector2d operator*(const Pose2& a_from_b, const Eigen::Vector2d& point_in_b);

/// Motion of a differential drive that travels `distance` [m] while it turns by `angle` [rad]:
/// an arc of constant curvature (the motion that the search of the paper runs through).
Pose2 Arc(double distance, double angle);

/// Length of the arc and sideways offset from it that make up a motion: the inverse of
/// `Arc(distance, angle) * (0, lateral, 0)`. For |angle| < pi.
struct ArcCoordinates {
  double distance = 0.0;  ///< [m]
  double lateral = 0.0;   ///< [m]
  double angle = 0.0;     ///< [rad]
};
ArcCoordinates ToArcCoordinates(const Pose2& motion);
Pose2 FromArcCoordinates(const ArcCoordinates& arc);

/// Velocity of a body in its own frame.
struct Velocity2 {
  double x = 0.0;      ///< forward [m/s]
  double y = 0.0;      ///< to the left [m/s]
  double theta = 0.0;  ///< counter-clockwise [rad/s]
};
Velocity2 operator+(const Velocity2& a, const Velocity2& b);
Velocity2 operator-(const Velocity2& a, const Velocity2& b);

/// Motion of a body that keeps its velocity for `dt` seconds (the exponential map of SE(2)).
Pose2 Move(const Velocity2& velocity, double dt);

/// The constant velocity that makes up `motion` in `dt` seconds, dt != 0: the inverse of Move.
Velocity2 VelocityOf(const Pose2& motion, double dt);

/// Moves from `a` (fraction 0) to `b` (fraction 1) with constant velocity in the body frame;
/// fractions outside [0, 1] extrapolate.
Pose2 Interpolate(const Pose2& a, const Pose2& b, double fraction);

/// A Pose2 with its sine and cosine, to move many points.
class RigidTransform2 {
 public:
  explicit RigidTransform2(const Pose2& pose)
      : cos_(std::cos(pose.theta)), sin_(std::sin(pose.theta)), x_(pose.x), y_(pose.y) {}

  Eigen::Vector2d operator*(const Eigen::Vector2d& p) const {
    return {x_ + cos_ * p.x() - sin_ * p.y(), y_ + sin_ * p.x() + cos_ * p.y()};
  }
  Eigen::Vector2d Rotate(const Eigen::Vector2d& v) const {
    return {cos_ * v.x() - sin_ * v.y(), sin_ * v.x() + cos_ * v.y()};
  }

 private:
  double cos_;
  double sin_;
  double x_;
  double y_;
};

}  // namespace scan_image_slam
