#include "scan_image_slam/core/mapping/pose_graph.h"

#include "scan_image_slam/core/geometry/covariance.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <ceres/ceres.h>

namespace scan_image_slam {
namespace {

/// S with S^T S = information, which may be singular.
Eigen::Matrix3d SquareRoot(const Eigen::Matrix3d& information) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(information);
  const Eigen::Vector3d roots = eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  return roots.asDiagonal() * eigen.eigenvectors().transpose();
}

/// What is left between the measured and the present pose of `to`, in the frame of the measured
/// one.
Eigen::Vector3d Difference(const Pose2& measured, const Pose2& from, const Pose2& to) {
  return (measured.Inverse() * (from.Inverse() * to)).coordinates();
}

/// Residual of a constraint by its two nodes (x, y, theta), with analytic derivatives.
class ConstraintCost : public ceres::SizedCostFunction<3, 3, 3> {
 public:
  explicit ConstraintCost(const GraphConstraint& constraint)
      : measured_(constraint.from_from_to), root_(SquareRoot(constraint.information)) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const Pose2 from{parameters[0][0], parameters[0][1], parameters[0][2]};
    const Pose2 to{parameters[1][0], parameters[1][1], parameters[1][2]};
    Eigen::Map<Eigen::Vector3d>(residuals, 3) = root_ * Difference(measured_, from, to);
    if (jacobians == nullptr) return true;
    // difference = R(-from - measured) (to - from) - const: the angle of the rotation is that of
    // the measured pose of `to` in the map.
    const double angle = from.theta + measured_.theta;
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    const double dx = to.x - from.x;
    const double dy = to.y - from.y;
    using Jacobian = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
    Eigen::Matrix3d by_to;
    by_to << c, s, 0, -s, c, 0, 0, 0, 1;
    if (jacobians[1] != nullptr) {
      Eigen::Map<Jacobian> jacobian(jacobians[1]);
      jacobian = root_ * by_to;
    }
    if (jacobians[0] != nullptr) {
      Eigen::Matrix3d by_from;
      by_from << -c, -s, -s * dx + c * dy, s, -c, -c * dx - s * dy, 0, 0, -1;
      Eigen::Map<Jacobian> jacobian(jacobians[0]);
      jacobian = root_ * by_from;
    }
    return true;
  }

 private:
  Pose2 measured_;
  Eigen::Matrix3d root_;
};

}  // namespace

GraphConstraint Chained(const GraphConstraint& first, const GraphConstraint& second) {
  GraphConstraint chained = second;
  chained.from = first.from;
  chained.robust = first.robust || second.robust;
  chained.from_from_to = first.from_from_to * second.from_from_to;
  const Eigen::Matrix3d covariance =
      TransportCovariance(first.information.inverse(), second.from_from_to) +
      second.information.inverse();
  chained.information = covariance.inverse();
  return chained;
}

double SquaredResidual(const GraphConstraint& constraint, const GraphPoses& nodes) {
  const Eigen::Vector3d d =
      Difference(constraint.from_from_to, nodes.at(constraint.from), nodes.at(constraint.to));
  return d.dot(constraint.information * d);
}

void OptimizeGraph(const std::vector<GraphConstraint>& constraints, int first_free,
                   const GraphOptions& options, GraphPoses* nodes) {
  first_free = std::max(1, first_free);
  std::map<int, Eigen::Vector3d> values;  // of the nodes that take part
  const auto value = [&](int node) {
    return values.try_emplace(node, nodes->at(node).coordinates()).first->second.data();
  };
  ceres::Problem problem;
  for (const GraphConstraint& constraint : constraints) {
    if (std::max(constraint.from, constraint.to) < first_free) continue;
    ceres::LossFunction* loss = constraint.robust ? new ceres::CauchyLoss(options.kernel) : nullptr;
    problem.AddResidualBlock(new ConstraintCost(constraint), loss, value(constraint.from),
                             value(constraint.to));
  }
  for (auto& [node, pose] : values) {
    if (node < first_free) problem.SetParameterBlockConstant(pose.data());
  }
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  solver.max_num_iterations = options.max_iterations;
  solver.num_threads = 1;
  solver.logging_type = ceres::SILENT;
  solver.function_tolerance = 1e-5;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  for (const auto& [node, pose] : values) {
    nodes->at(node) = {pose.x(), pose.y(), NormalizeAngle(pose.z())};
  }
}

}  // namespace scan_image_slam
