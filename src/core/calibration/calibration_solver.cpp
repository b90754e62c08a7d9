#include "scan_image_slam/core/calibration/calibration_solver.h"

#include "scan_image_slam/core/calibration/upright_edges.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <vector>

#include <Eigen/Dense>
#include <ceres/ceres.h>

namespace scan_image_slam {
namespace {

using Vector = Eigen::Matrix<double, kCalibrationSize, 1>;
using Matrix = Eigen::Matrix<double, kCalibrationSize, kCalibrationSize>;

/// What is known before: so much that the least squares never lack a solution.
const CalibrationVector kPriorStddev = {0.2, 0.2, 0.2, 0.1, 0.1, 0.1, 0.004};
/// What is less certain is refused.
const CalibrationVector kMaxStddev = {0.002, 0.01, 0.01, 0.004, 0.005, 0.005, 1.0};
constexpr double kUprightStddev = 0.005;  // of what is taken to be vertical [rad]
constexpr double kKernel = 2.0;           // residuals of so many standard deviations count half

struct PairCost {
  CalibrationPair pair;
  Eigen::Vector2d camera;
  double stddev;
  template <typename T>
  bool operator()(const T* correction, T* residual) const {
    *residual = BearingResidual(pair.sight, pair.edge, camera, correction) / stddev;
    return true;
  }
};

/// An upright edge leans by what the camera is tilted.
struct LeanCost {
  ViewedEdge edge;
  double stddev;
  template <typename T>
  bool operator()(const T* correction, T* residual) const {
    *residual = (edge.lean - correction[kTiltX] * std::cos(edge.bearing) -
                 correction[kTiltY] * std::sin(edge.bearing)) /
                stddev;
    return true;
  }
};

struct PriorCost {
  int index;
  template <typename T>
  bool operator()(const T* correction, T* residual) const {
    *residual = correction[index] / kPriorStddev[index];
    return true;
  }
};

/// One residual of the problem and the block of time that it belongs to.
struct Term {
  std::unique_ptr<ceres::CostFunction> cost;
  int block = -1;  ///< -1: a prior
};

template <typename Cost>
std::unique_ptr<ceres::CostFunction> MakeCost(Cost cost) {
  return std::make_unique<ceres::AutoDiffCostFunction<Cost, 1, kCalibrationSize>>(new Cost(cost));
}

class LeastSquares {
 public:
  LeastSquares(const CalibrationData& data, const CalibrationSolverOptions& options)
      : data_(data), options_(options) {}

  void Add(const std::vector<CalibrationPair>& pairs) {
    for (const CalibrationPair& pair : pairs) {
      const double stddev = std::hypot(pair.sight.bearing_stddev, kEdgeStddev * data_.pixel);
      terms_.push_back({MakeCost(PairCost{pair, data_.camera, stddev}), Block(pair.sight.view)});
    }
  }
  void AddLeans() {
    for (int v = 0; v < static_cast<int>(data_.views.size()); ++v) {
      for (const ViewedEdge& edge : data_.views[v].edges) {
        const double stddev = std::hypot(edge.lean_stddev, kUprightStddev);
        terms_.push_back({MakeCost(LeanCost{edge, stddev}), Block(v)});
      }
    }
  }
  void AddPriors() {
    for (int i = 0; i < kCalibrationSize; ++i) terms_.push_back({MakeCost(PriorCost{i}), -1});
  }

  CalibrationVector Solve(CalibrationVector start) const {
    ceres::Problem::Options ownership;
    ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ownership.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ceres::CauchyLoss loss(kKernel);
    ceres::Problem problem(ownership);
    for (const Term& term : terms_) {
      problem.AddResidualBlock(term.cost.get(), term.block < 0 ? nullptr : &loss, start.data());
    }
    ceres::Solver::Options solver;
    solver.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
    solver.num_threads = 1;
    solver.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(solver, &problem, &summary);
    return start;
  }

  /// Standard deviations from the information matrix, and from how the gradients of blocks of time
  /// scatter (pairs of the same things err together): the larger ones.
  CalibrationVector Stddevs(const CalibrationVector& at) const {
    Matrix information = Matrix::Zero();
    Matrix prior = Matrix::Zero();
    std::map<int, Vector> gradients;
    for (const Term& term : terms_) {
      Vector jacobian;
      double residual = 0.0;
      const double* parameters = at.data();
      double* rows = jacobian.data();
      term.cost->Evaluate(&parameters, &residual, &rows);
      if (term.block < 0) {
        prior += jacobian * jacobian.transpose();
        continue;
      }
      const double weight = 1.0 / (1.0 + residual * residual / (kKernel * kKernel));
      information += weight * jacobian * jacobian.transpose();
      const auto entry = gradients.try_emplace(term.block, Vector::Zero()).first;
      entry->second += weight * residual * jacobian;
    }
    Matrix scatter = prior;
    for (const auto& [block, gradient] : gradients) scatter += gradient * gradient.transpose();
    const Matrix covariance = (information + prior).inverse();
    const Matrix of_blocks = covariance * scatter * covariance;
    CalibrationVector stddevs{};
    for (int i = 0; i < kCalibrationSize; ++i) {
      stddevs[i] = std::sqrt(std::max(covariance(i, i), of_blocks(i, i)));
    }
    return stddevs;
  }

 private:
  int Block(int view) const {
    return static_cast<int>(Seconds(data_.views[view].stamp - data_.views.front().stamp) /
                            options_.block);
  }

  const CalibrationData& data_;
  const CalibrationSolverOptions& options_;
  std::vector<Term> terms_;
};

struct Fit {
  CalibrationVector correction{};
  CalibrationVector stddevs{};
  std::vector<CalibrationPair> pairs;
};

/// Pairs and least squares in turn, with the gate as multiples of the final one.
Fit Refine(const CalibrationData& data, const CalibrationVector& start,
           const std::vector<double>& gates, const CalibrationSolverOptions& options) {
  Fit fit;
  fit.correction = start;
  for (const double gate : gates) {
    fit.pairs = PairNearest(data, SightJumps(data, fit.correction[kTime]), fit.correction,
                            gate * options.final_gate);
    LeastSquares problem(data, options);
    problem.Add(fit.pairs);
    problem.AddLeans();
    problem.AddPriors();
    fit.correction = problem.Solve(fit.correction);
    fit.stddevs = problem.Stddevs(fit.correction);
  }
  return fit;
}

/// Some views of the whole drive, for what needs no precision.
CalibrationData Thinned(const CalibrationData& data, std::size_t views) {
  CalibrationData thinned = data;
  if (data.views.size() <= views) return thinned;
  thinned.views.clear();
  for (std::size_t i = 0; i < views; ++i) {
    thinned.views.push_back(data.views[i * data.views.size() / views]);
  }
  return thinned;
}

/// Of the candidates of the coarse search the one that finds most pairs once it is refined.
CalibrationVector BestStart(const CalibrationData& all, const CalibrationSolverOptions& options) {
  const CalibrationData data = Thinned(all, options.search_views);
  CalibrationVector best{};
  std::size_t most = 0;
  for (const CalibrationVector& candidate : SearchCoarsely(data, options.search)) {
    const CalibrationVector refined =
        Refine(data, candidate, {6.0, 4.0, 2.5, 1.5, 1.0}, options).correction;
    const std::size_t pairs =
        PairNearest(data, SightJumps(data, refined[kTime]), refined, options.final_gate).size();
    if (pairs <= most) continue;
    most = pairs;
    best = refined;
  }
  return best;
}

double RmsPixels(const CalibrationData& data, const std::vector<CalibrationPair>& pairs,
                 const CalibrationVector& correction) {
  double squares = 0.0;
  for (const CalibrationPair& pair : pairs) {
    const double residual =
        BearingResidual(pair.sight, pair.edge, data.camera, correction.data()) / data.pixel;
    squares += residual * residual;
  }
  return pairs.empty() ? 0.0 : std::sqrt(squares / static_cast<double>(pairs.size()));
}

/// Pairs found with the camera turned to where nothing fits.
double PairsByChance(const CalibrationData& data, const std::vector<JumpSight>& sights,
                     CalibrationVector correction, double gate) {
  double sum = 0.0;
  const std::array<double, 6> turns = {-0.09, -0.06, -0.03, 0.03, 0.06, 0.09};
  const double yaw = correction[kYaw];
  for (const double turn : turns) {
    correction[kYaw] = yaw + turn;
    sum += static_cast<double>(PairNearest(data, sights, correction, gate).size());
  }
  return sum / static_cast<double>(turns.size());
}

std::string ReasonFor(int index) {
  switch (index) {
    case kTime:
      return "the robot turned too little to tell a delay from a place; drive curves both ways";
    case kForward:
      return "the edges lie in too few directions, or the robot turned too little; drive curves "
             "near objects";
    case kLeft:
      return "the edges lie at too few distances; drive past near objects, too";
    case kTiltX:
    case kTiltY:
      return "too few long vertical edges";
    default:
      return "the edges lie too close together; drive past objects on both sides";
  }
}

std::string RefusalOf(const CalibrationResult& result, const CalibrationSolverOptions& options) {
  const std::string found = std::to_string(result.pairs) +
                            " pairs of a vertical edge and a range discontinuity in " +
                            std::to_string(result.views) + " views";
  if (result.pairs < options.min_pairs) {
    return "too few pairs: " + found + ", at least " + std::to_string(options.min_pairs) +
           " are needed; drive longer, past door frames, cupboards and legs of tables";
  }
  if (result.pairs < options.min_over_chance * result.by_chance) {
    return "no place of the camera fits: " + found + ", where chance makes " +
           std::to_string(std::lround(result.by_chance)) +
           "; the pose may be off by more than is searched, or the intrinsics may be wrong";
  }
  if (!result.quantities[kYaw].refusal.empty()) {
    return "too little spread: " + found + ", but " + result.quantities[kYaw].refusal;
  }
  return "";
}

}  // namespace

CalibrationVector CalibrationResult::Correction() const {
  CalibrationVector correction{};
  for (int i = 0; i < kCalibrationSize; ++i) correction[i] = quantities[i].correction;
  return correction;
}

CalibrationResult Calibrate(const CalibrationData& data, const CalibrationSolverOptions& options) {
  CalibrationResult result;
  for (const CalibrationView& view : data.views) {
    if (!view.edges.empty() && !view.jumps.empty()) ++result.views;
  }
  const Fit fit = Refine(data, BestStart(data, options), {1.5, 1.0, 1.0, 1.0, 1.0}, options);
  const std::vector<CalibrationPair>& pairs = fit.pairs;
  const CalibrationVector& correction = fit.correction;
  const CalibrationVector& stddevs = fit.stddevs;
  result.pairs = static_cast<int>(pairs.size());
  result.by_chance =
      PairsByChance(data, SightJumps(data, correction[kTime]), correction, options.final_gate);
  result.rms_before = RmsPixels(data, pairs, CalibrationVector{});
  result.rms_after = RmsPixels(data, pairs, correction);
  for (int i = 0; i < kCalibrationSize; ++i) {
    const bool observable = stddevs[i] <= kMaxStddev[i];
    result.quantities[i] = {observable ? correction[i] : 0.0, stddevs[i],
                            observable ? "" : ReasonFor(i)};
  }
  result.refusal = RefusalOf(result, options);
  return result;
}

}  // namespace scan_image_slam
