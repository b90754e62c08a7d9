#include "scan_image_slam/core/geometry/covariance.h"

#include "core/geometry/pose_near.h"

#include <cmath>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

/// A motion as a homogeneous matrix, so that the oracle shares no code with Pose2.
Eigen::Matrix3d Matrix(double x, double y, double theta) {
  Eigen::Matrix3d m;
  m << std::cos(theta), -std::sin(theta), x, std::sin(theta), std::cos(theta), y, 0, 0, 1;
  return m;
}

Eigen::Vector3d SmallMotion(const Eigen::Matrix3d& m) {
  return {m(0, 2), m(1, 2), std::atan2(m(1, 0), m(0, 0))};
}

/// By differences: how an error before the motion shows as an error after it.
Eigen::Matrix3d NumericalJacobian(const Pose2& motion) {
  constexpr double kStep = 1e-5;
  const Eigen::Matrix3d m = Matrix(motion.x, motion.y, motion.theta);
  Eigen::Matrix3d jacobian;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d e = kStep * Eigen::Vector3d::Unit(i);
    const Eigen::Matrix3d plus = m.inverse() * Matrix(e.x(), e.y(), e.z()) * m;
    const Eigen::Matrix3d minus = m.inverse() * Matrix(-e.x(), -e.y(), -e.z()) * m;
    jacobian.col(i) = (SmallMotion(plus) - SmallMotion(minus)) / (2.0 * kStep);
  }
  return jacobian;
}

Eigen::Matrix3d RandomCovariance(Dice* dice) {
  Eigen::Matrix3d a;
  for (int i = 0; i < 9; ++i) a(i / 3, i % 3) = dice->Between(-1.0, 1.0);
  return a * a.transpose();
}

TEST(TransportCovariance, AgreesWithTheNumericalJacobian) {
  Dice dice;
  for (int i = 0; i < 50; ++i) {
    const Pose2 motion = dice.Pose();
    const Eigen::Matrix3d covariance = RandomCovariance(&dice);
    const Eigen::Matrix3d jacobian = NumericalJacobian(motion);
    const Eigen::Matrix3d expected = jacobian * covariance * jacobian.transpose();
    EXPECT_NEAR((TransportCovariance(covariance, motion) - expected).norm(), 0.0,
                1e-7 * expected.norm());
  }
}

TEST(TransportCovariance, AHeadingErrorBecomesASidewaysErrorOverTheWay) {
  const Eigen::Matrix3d before = Eigen::Vector3d(0.0, 0.0, 0.01).asDiagonal();
  Eigen::Matrix3d after;  // the base ends 3 m times the error farther left
  after << 0, 0, 0, 0, 0.09, 0.03, 0, 0.03, 0.01;
  EXPECT_NEAR((TransportCovariance(before, {3.0, 0.0, 0.0}) - after).norm(), 0.0, 1e-15);
}

TEST(TransportCovariance, AQuarterTurnSwapsForwardAndSideways) {
  const Eigen::Matrix3d before = Eigen::Vector3d(1.0, 2.0, 3.0).asDiagonal();
  const Eigen::Matrix3d after = Eigen::Vector3d(2.0, 1.0, 3.0).asDiagonal();
  EXPECT_NEAR((TransportCovariance(before, {0.0, 0.0, M_PI / 2.0}) - after).norm(), 0.0, 1e-14);
}

TEST(TransportCovariance, OverTwoMotionsIsOverTheirChain) {
  Dice dice;
  for (int i = 0; i < 50; ++i) {
    const Pose2 a = dice.Pose();
    const Pose2 b = dice.Pose();
    const Eigen::Matrix3d covariance = RandomCovariance(&dice);
    const Eigen::Matrix3d twice = TransportCovariance(TransportCovariance(covariance, a), b);
    EXPECT_NEAR((TransportCovariance(covariance, a * b) - twice).norm(), 0.0, 1e-12 * twice.norm());
  }
}

}  // namespace
}  // namespace scan_image_slam
