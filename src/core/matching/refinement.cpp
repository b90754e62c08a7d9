#include "scan_image_slam/core/matching/refinement.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace scan_image_slam {
namespace {

/// Least squares in the tangent space of the pose: information * step = -gradient.
struct NormalEquations {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();

  NormalEquations& operator+=(const NormalEquations& other) {
    information += other.information;
    gradient += other.gradient;
    return *this;
  }
};

/// Weight of Cauchy's kernel: 1 for small residuals, 1/2 at `kernel` standard deviations.
double CauchyWeight(double squared_residual, double variance, double kernel) {
  return 1.0 / (1.0 + squared_residual / (kernel * kernel * variance));
}

/// How good the residuals are by what the noise lets expect, from their median (Rousseeuw and Leroy
/// 1987): a kernel made for a noisy laser lets wrong neighbours through when the laser is exact.
double VarianceScale(std::vector<double> normalized_squares) {
  constexpr double kMedianOfChiSquare = 0.455;
  constexpr double kLeast = 1e-4;
  constexpr double kMost = 9.0;
  constexpr std::size_t kFewest = 10;  // so few say nothing
  if (normalized_squares.size() < kFewest) return 1.0;
  const auto middle =
      normalized_squares.begin() + static_cast<std::ptrdiff_t>(normalized_squares.size() / 2);
  std::nth_element(normalized_squares.begin(), middle, normalized_squares.end());
  return std::clamp(*middle / kMedianOfChiSquare, kLeast, kMost);
}

/// A point on its element: the Jacobian of the residual n . (R p + t - q) by (forward, left, turn)
/// in the base frame is (n_b, n_b x p) with n_b the normal seen from the base.
struct PointRow {
  Eigen::Vector2d point{0, 0};   // in the base frame [m]
  Eigen::Vector2d normal{0, 0};  // in the base frame
  double residual = 0.0;         // [m]
  double weight = 0.0;           // [1/m^2]
};
using Rows = std::vector<PointRow>;

struct ScanTerm {
  Rows rows;                    // in the order of the scan
  double variance_scale = 1.0;  // for the sums that come next
  double weighted_squares = 0.0;
  double weights = 0.0;
};

ScanTerm MatchPoints(const std::vector<SurfacePoint>& points, const LocalMap& map,
                     const RangeNoise& noise, const Pose2& map_from_base,
                     const RefinementOptions& options, double gate, double variance_scale) {
  ScanTerm term;
  term.rows.reserve(points.size());
  std::vector<double> normalized_squares;
  normalized_squares.reserve(points.size());
  const RigidTransform2 transform(map_from_base);
  const RigidTransform2 rotate_back(Pose2{0.0, 0.0, -map_from_base.theta});
  const double model_variance = options.model_stddev * options.model_stddev;
  for (const SurfacePoint& p : points) {
    const Eigen::Vector2d place = transform * p.point;
    const SurfaceElement* element = map.Nearest(place);
    if (element == nullptr) continue;
    const Eigen::Vector2d normal = element->normal.cast<double>();
    const Eigen::Vector2d offset = place - element->position.cast<double>();
    const double residual = normal.dot(offset);
    const double along = Cross(normal, offset);
    if (std::abs(residual) > gate || std::abs(along) > options.along_gate) continue;
    const Eigen::Vector2d n = rotate_back.Rotate(normal);
    const double cosine = -n.dot(p.ray);
    if (cosine <= 0.0) continue;  // the wall's other side
    if (p.has_normal() && p.normal.dot(n) < options.min_normal_cosine) continue;
    const double expected =
        model_variance + noise.VarianceAcross(p.range, cosine) + 1.0 / element->information;
    const double squared = residual * residual;
    normalized_squares.push_back(squared / expected);
    const double variance = variance_scale * expected;
    const double w = CauchyWeight(squared, variance, options.kernel) / variance;
    term.rows.push_back({p.point, n, residual, w});
    term.weighted_squares += w * squared;
    term.weights += w;
  }
  term.variance_scale = VarianceScale(std::move(normalized_squares));
  return term;
}

NormalEquations SumOver(const Rows& rows, double correlation) {
  double xx = 0, xy = 0, yy = 0, xt = 0, yt = 0, tt = 0, gx = 0, gy = 0, gt = 0;
  for (const PointRow& row : rows) {
    const Eigen::Vector2d& n = row.normal;
    const double turn = row.point.x() * n.y() - row.point.y() * n.x();
    const double w = row.weight / correlation;
    xx += w * n.x() * n.x();
    xy += w * n.x() * n.y();
    yy += w * n.y() * n.y();
    xt += w * n.x() * turn;
    yt += w * n.y() * turn;
    tt += w * turn * turn;
    gx += w * n.x() * row.residual;
    gy += w * n.y() * row.residual;
    gt += w * turn * row.residual;
  }
  NormalEquations sum;
  sum.information << xx, xy, xt, xy, yy, yt, xt, yt, tt;
  sum.gradient << gx, gy, gt;
  return sum;
}

struct EdgeTerm {
  NormalEquations equations;
  int matched = 0;
};

/// Sums over the edges: residual is how far the landmark lies off the line of sight.
EdgeTerm SumOverEdges(const EdgeEvidence& evidence, const Pose2& map_from_base,
                      const RefinementOptions& options) {
  const RigidTransform2 transform(map_from_base);
  EdgeTerm term;
  for (const ModelEdge& edge : evidence.edges) {
    const EdgeLandmark* landmark = evidence.map.Find(edge, transform);
    if (landmark == nullptr) continue;
    const Eigen::Vector2d n = Across(Direction(edge.bearing));
    const Eigen::Vector2d across = transform.Rotate(n);
    const Eigen::Vector2d p = edge.point();
    const double residual = across.dot(transform * p - landmark->position);
    const double variance =
        std::pow(edge.bearing_stddev * edge.range, 2) + across.dot(landmark->covariance * across);
    const double w = CauchyWeight(residual * residual, variance, options.kernel) /
                     (variance * options.edge_correlation);
    const Eigen::Vector3d jacobian(n.x(), n.y(), Cross(p, n));
    term.equations.information += w * jacobian * jacobian.transpose();
    term.equations.gradient += w * residual * jacobian;
    ++term.matched;
  }
  return term;
}

/// The direction that is known so much worse than the one across it, as along a plain corridor.
std::optional<Eigen::Vector2d> WeakDirection(const Eigen::Matrix3d& h, double ratio) {
  if (h(2, 2) <= 0.0) return std::nullopt;
  const Eigen::Matrix2d translation =
      h.topLeftCorner<2, 2>() - h.topRightCorner<2, 1>() * h.bottomLeftCorner<1, 2>() / h(2, 2);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(translation);
  if (eigen.eigenvalues()(0) >= ratio * eigen.eigenvalues()(1)) return std::nullopt;
  return eigen.eigenvectors().col(0);
}

/// Takes out what is said about a direction.
NormalEquations Without(const Eigen::Vector2d& direction, const NormalEquations& equations) {
  Eigen::Matrix3d project = Eigen::Matrix3d::Identity();
  project.topLeftCorner<2, 2>() -= direction * direction.transpose();
  return {project * equations.information * project, project * equations.gradient};
}

/// What a scan tells, and the direction that is known much worse than the one across it.
struct ScanEvidence {
  NormalEquations equations;
  std::optional<Eigen::Vector2d> weak;
  bool told = true;  ///< there are walls that face the weak direction
};

/// Parts the points on walls that face a direction, such as the end of a corridor, from all others.
/// What is no wider than people may walk.
std::pair<Rows, Rows> PartFacingWalls(const Rows& rows, const Eigen::Vector2d& direction) {
  constexpr double kLeastCosine = 0.5;
  constexpr double kLeastWidth = 0.8;  // [m]
  constexpr double kWidestGap = 0.3;   // between points of one wall [m]
  constexpr std::size_t kFewestPoints = 5;
  Rows facing_walls, others, group;
  const auto end_group = [&] {
    const bool is_wall = group.size() >= kFewestPoints &&
                         (group.back().point - group.front().point).norm() >= kLeastWidth;
    Rows& part = is_wall ? facing_walls : others;
    part.insert(part.end(), group.begin(), group.end());
    group.clear();
  };
  for (const PointRow& row : rows) {
    const bool faces = std::abs(row.normal.dot(direction)) >= kLeastCosine;
    if (!group.empty() && !(faces && (row.point - group.back().point).norm() < kWidestGap)) {
      end_group();
    }
    (faces ? group : others).push_back(row);
  }
  if (!group.empty()) end_group();
  return {facing_walls, others};
}

/// Of the weak direction only walls that face it tell anything: what those along it seem to tell is
/// noise of their normals.
ScanEvidence Weigh(const Rows& rows, const RefinementOptions& options) {
  ScanEvidence evidence;
  evidence.equations = SumOver(rows, options.correlation);
  evidence.weak = WeakDirection(evidence.equations.information, options.degenerate_ratio);
  if (!evidence.weak) return evidence;
  const auto [facing_walls, others] = PartFacingWalls(rows, *evidence.weak);
  evidence.told = !facing_walls.empty();
  evidence.equations = Without(*evidence.weak, SumOver(others, options.correlation));
  evidence.equations += SumOver(facing_walls, options.correlation);
  return evidence;
}

struct PriorTerm {
  NormalEquations equations;
  double weight = 1.0;
};

PriorTerm PriorAt(const MotionPrior& prior, const Eigen::Matrix3d& prior_information,
                  const Pose2& map_from_base) {
  const Pose2 deviation = prior.map_from_base.Inverse() * map_from_base;
  const Eigen::Vector3d d = deviation.coordinates();
  const double squared = d.dot(prior_information * d);
  const double weight = CauchyWeight(squared, 1.0, prior.kernel);
  const Eigen::Matrix3d weighted = weight * prior_information;
  return {{weighted, weighted * d}, weight};
}

}  // namespace

void RefinementOptions::Validate() const {
  const auto require = [](bool ok, const char* what) {
    if (!ok) throw std::invalid_argument(what);
  };
  require(max_iterations >= 0, "max_iterations must not be negative");
  require(gate > 0.0, "gate must be positive");
  require(along_gate > 0.0, "along_gate must be positive");
  require(model_stddev > 0.0, "model_stddev must be positive");
  require(kernel > 0.0, "kernel must be positive");
  require(correlation >= 1.0, "correlation must be at least 1");
  require(edge_correlation >= 1.0, "edge_correlation must be at least 1");
  require(std::abs(min_normal_cosine) <= 1.0, "min_normal_cosine must be between -1 and 1");
  require(degenerate_ratio >= 0.0 && degenerate_ratio <= 1.0,
          "degenerate_ratio must be between 0 and 1");
}

Refinement Refine(const std::vector<SurfacePoint>& points, const LocalMap& map,
                  const RangeNoise& noise, const MotionPrior& prior, const Pose2& start,
                  const RefinementOptions& options, const EdgeEvidence* evidence) {
  constexpr int kWideIterations = 2;  // first steps from the grid, which is coarser than the gate
  constexpr double kSmallStep = 1e-5;
  const Eigen::Matrix3d prior_information = prior.covariance.inverse();
  Refinement result;
  result.map_from_base = start;
  result.covariance = prior.covariance;
  double variance_scale = 1.0;
  for (int i = 0; i <= options.max_iterations; ++i) {
    const double gate = i < kWideIterations ? 2.0 * options.gate : options.gate;
    const Pose2 pose = result.map_from_base;
    const ScanTerm scan = MatchPoints(points, map, noise, pose, options, gate, variance_scale);
    variance_scale = scan.variance_scale;
    result.matched = static_cast<int>(scan.rows.size());
    result.rms = scan.weights > 0.0 ? std::sqrt(scan.weighted_squares / scan.weights) : 0.0;
    const EdgeTerm edge = evidence == nullptr ? EdgeTerm() : SumOverEdges(*evidence, pose, options);
    result.matched_edges = edge.matched;
    const ScanEvidence told = Weigh(scan.rows, options);
    NormalEquations equations = told.equations;
    equations += edge.equations;
    result.information = equations.information;
    result.gradient = equations.gradient;
    result.linearised_at = pose;
    result.weak = told.weak.has_value();
    result.degenerate = !told.told;
    result.degenerate_direction = told.weak ? std::atan2(told.weak->y(), told.weak->x()) : 0.0;
    const PriorTerm before = PriorAt(prior, prior_information, pose);
    equations += before.equations;
    result.prior_weight = before.weight;
    if (i == options.max_iterations) break;
    result.covariance = equations.information.inverse();
    const Eigen::Vector3d step = -equations.information.ldlt().solve(equations.gradient);
    result.map_from_base = pose * Pose2{step.x(), step.y(), step.z()};
    if (i >= kWideIterations && step.cwiseAbs().maxCoeff() < kSmallStep) break;
  }
  return result;
}

}  // namespace scan_image_slam
