#include "scan_image_slam/core/geometry/pose2.h"

namespace scan_image_slam {
namespace {

constexpr double kSmallAngle = 1e-6;

/// sin(x) / x and (1 - cos(x)) / x, continuous at zero.
struct Chord {
  double along;
  double across;
};
Chord UnitChord(double angle) {
  if (std::abs(angle) < kSmallAngle) return {1.0 - angle * angle / 6.0, angle / 2.0};
  return {std::sin(angle) / angle, (1.0 - std::cos(angle)) / angle};
}

}  // namespace

double NormalizeAngle(double angle) {
  if (angle > -M_PI && angle <= M_PI) return angle;
  angle = std::remainder(angle, 2.0 * M_PI);
  return angle <= -M_PI ? M_PI : angle;
}

Pose2 Pose2::Inverse() const {
  const double c = std::cos(theta);
  const double s = std::sin(theta);
  return {-c * x - s * y, s * x - c * y, NormalizeAngle(-theta)};
}

bool IsFinite(const Pose2& pose) {
  return std::isfinite(pose.x) && std::isfinite(pose.y) && std::isfinite(pose.theta);
}

Pose2 operator*(const Pose2& a_from_b, const Pose2& b_from_c) {
  const Eigen::Vector2d t = a_from_b * b_from_c.translation();
  return {t.x(), t.y(), NormalizeAngle(a_from_b.theta + b_from_c.theta)};
}

Eigen::Vector2d operator*(const Pose2& a_from_b, const Eigen::Vector2d& point_in_b) {
  return RigidTransform2(a_from_b) * point_in_b;
}

Pose2 Arc(double distance, double angle) {
  const Chord chord = UnitChord(angle);
  return {distance * chord.along, distance * chord.across, NormalizeAngle(angle)};
}

Pose2 FromArcCoordinates(const ArcCoordinates& arc) {
  return Arc(arc.distance, arc.angle) * Pose2{0.0, arc.lateral, 0.0};
}

ArcCoordinates ToArcCoordinates(const Pose2& motion) {
  // With the half angle h = angle / 2 the arc ends at distance * sinc(h) * (cos h, sin h), and the
  // lateral offset points along (-sin 2h, cos 2h). Turning by -h leaves two equations:
  //   along  = distance * sinc(h) - lateral * sin(h),   across = lateral * cos(h).
  const double h = motion.theta / 2.0;
  const double c = std::cos(h);
  const double s = std::sin(h);
  const double along = c * motion.x + s * motion.y;
  const double across = -s * motion.x + c * motion.y;
  const double sinc = UnitChord(h).along;
  const double lateral = across / c;
  return {(along + lateral * s) / sinc, lateral, motion.theta};
}

Velocity2 operator+(const Velocity2& a, const Velocity2& b) {
  return {a.x + b.x, a.y + b.y, a.theta + b.theta};
}

Velocity2 operator-(const Velocity2& a, const Velocity2& b) {
  return {a.x - b.x, a.y - b.y, a.theta - b.theta};
}

Pose2 Move(const Velocity2& velocity, double dt) {
  const double angle = velocity.theta * dt;
  const Chord chord = UnitChord(angle);
  return {dt * (chord.along * velocity.x - chord.across * velocity.y),
          dt * (chord.across * velocity.x + chord.along * velocity.y), NormalizeAngle(angle)};
}

Velocity2 VelocityOf(const Pose2& motion, double dt) {
  const Chord chord = UnitChord(motion.theta);
  const double scale = 1.0 / (dt * (chord.along * chord.along + chord.across * chord.across));
  return {scale * (chord.along * motion.x + chord.across * motion.y),
          scale * (-chord.across * motion.x + chord.along * motion.y), motion.theta / dt};
}

Pose2 Interpolate(const Pose2& a, const Pose2& b, double fraction) {
  return a * Move(VelocityOf(a.Inverse() * b, 1.0), fraction);
}

}  // namespace scan_image_slam
