#include "scan_image_slam/core/fusion/step_fit.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace scan_image_slam {
namespace {

constexpr double kBlur = 0.7;          // of lens, pixels and resampling, standard deviation [px]
constexpr double kBlurStddev = 0.25;   // motion and defocus make it greater [px]
constexpr double kColumnStddev = 0.7;  // of the columns to start with [px]
constexpr double kSlopeStddev = 1.0;   // of the shading [grey levels / px]
constexpr double kModelError = 0.01;   // of the greatest step
constexpr int kIterations = 15;
constexpr double kSmallStep = 3e-3;  // [px]

/// Parameters: level, slope, blur, then of each step its column and its height.
constexpr int kLevel = 0;
constexpr int kSlope = 1;
constexpr int kSpread = 2;
constexpr int ColumnIndex(int step) { return 3 + 2 * step; }
constexpr int HeightIndex(int step) { return 4 + 2 * step; }

constexpr int kMostParameters = HeightIndex(kMostSteps - 1) + 1;
using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostParameters, 1>;
using Matrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostParameters, kMostParameters>;

class Fit {
 public:
  Fit(const GreyProfile& profile, const std::vector<double>& columns)
      : profile_(profile),
        steps_(static_cast<int>(columns.size())),
        x_(Vector::Zero(3 + 2 * steps_)),
        prior_(x_),
        weight_(x_) {
    middle_ = columns.front();
    prior_[kSpread] = kBlur;
    weight_[kSpread] = 1.0 / (kBlurStddev * kBlurStddev);
    weight_[kSlope] = 1.0 / (kSlopeStddev * kSlopeStddev);
    for (int k = 0; k < steps_; ++k) {
      prior_[ColumnIndex(k)] = columns[k];
      weight_[ColumnIndex(k)] = 1.0 / (kColumnStddev * kColumnStddev);
    }
    x_ = prior_;
    variance_ = profile.stddev * profile.stddev;
  }

  bool Run() {
    // The levels are linear in all but the columns and the blur, which stay in the first step.
    Step(/*linear_only=*/true);
    double highest = 0.0;
    for (int k = 0; k < steps_; ++k) highest = std::max(highest, std::abs(x_[HeightIndex(k)]));
    variance_ += kModelError * kModelError * highest * highest;
    for (int i = 0; i < kIterations; ++i) {
      if (Step(/*linear_only=*/false) < kSmallStep) return true;
    }
    return false;
  }

  /// True if the profile tells more of the first column than was known before. Where two steps are
  /// in one column their heights can be anything, and rounding makes any variance, also below zero.
  bool Sees() const {
    const double variance = FirstVariance();
    return variance > 0.0 && variance < 0.5 * kColumnStddev * kColumnStddev;
  }

  StepFit First() const {
    const int size = static_cast<int>(profile_.levels.size());
    const double freedom = std::max(1.0, size - static_cast<double>(x_.size()));
    const double misfit = std::max(1.0, squares_ / freedom);
    const int column = ColumnIndex(0);
    return {x_[column], std::sqrt(misfit * FirstVariance()), x_[HeightIndex(0)]};
  }

 private:
  double FirstVariance() const {
    const int column = ColumnIndex(0);
    return information_.ldlt().solve(Vector::Unit(x_.size(), column))[column];
  }

  /// One step of Gauss and Newton; the greatest change of a column [px].
  double Step(bool linear_only) {
    const int n = static_cast<int>(x_.size());
    information_ = weight_.asDiagonal();
    Vector gradient = weight_.cwiseProduct(x_ - prior_);
    Vector derivative(n);
    squares_ = 0.0;
    for (std::size_t i = 0; i < profile_.levels.size(); ++i) {
      const double residual =
          Evaluate(profile_.first_column + static_cast<double>(i), &derivative) -
          profile_.levels[i];
      squares_ += residual * residual / variance_;
      gradient += derivative * (residual / variance_);
      information_.selfadjointView<Eigen::Lower>().rankUpdate(derivative, 1.0 / variance_);
    }
    if (linear_only) {
      Freeze(kSpread, &gradient);
      for (int k = 0; k < steps_; ++k) Freeze(ColumnIndex(k), &gradient);
    }
    Vector step = -information_.ldlt().solve(gradient);
    double moved = 0.0;
    for (int k = 0; k < steps_; ++k) {
      double& along = step[ColumnIndex(k)];
      along = std::clamp(along, -0.5, 0.5);
      moved = std::max(moved, std::abs(along));
    }
    x_ += step;
    x_[kSpread] = std::clamp(x_[kSpread], 0.5 * kBlur, 4.0 * kBlur);
    return moved;
  }

  void Freeze(int parameter, Vector* gradient) {
    information_.row(parameter).setZero();
    information_.col(parameter).setZero();
    information_(parameter, parameter) = 1.0;
    (*gradient)[parameter] = 0.0;
  }

  double Evaluate(double column, Vector* derivative) const {
    constexpr double kRootOfTwoPi = 2.5066282746310002;
    constexpr double kFlat = 4.0;  // [standard deviations]
    const double spread = x_[kSpread];
    Vector& d = *derivative;
    d[kLevel] = 1.0;
    d[kSlope] = column - middle_;
    d[kSpread] = 0.0;
    double level = x_[kLevel] + x_[kSlope] * d[kSlope];
    for (int k = 0; k < steps_; ++k) {
      const double z = (column - x_[ColumnIndex(k)]) / spread;
      const double height = x_[HeightIndex(k)];
      if (std::abs(z) > kFlat) {  // beside the step
        level += z > 0.0 ? height : 0.0;
        d[HeightIndex(k)] = z > 0.0 ? 1.0 : 0.0;
        d[ColumnIndex(k)] = 0.0;
        continue;
      }
      const double share = 0.5 * std::erfc(-z * M_SQRT1_2);
      const double density = std::exp(-0.5 * z * z) / (kRootOfTwoPi * spread);
      level += height * share;
      d[HeightIndex(k)] = share;
      d[ColumnIndex(k)] = -height * density;
      d[kSpread] -= height * density * z;
    }
    return level;
  }

  const GreyProfile& profile_;
  int steps_;
  double middle_ = 0.0;
  double variance_ = 1.0;
  double squares_ = 0.0;
  Vector x_;
  Vector prior_;
  Vector weight_;
  Matrix information_;
};

}  // namespace

std::optional<StepFit> FitFirstStep(const GreyProfile& profile,
                                    const std::vector<double>& columns) {
  constexpr std::size_t kFewest = 5;  // levels, for an even slope, a step and its blur
  constexpr double kFarthest = 1.5;   // from where it was said to be [px]
  if (columns.empty() || columns.size() > kMostSteps || profile.levels.size() < kFewest)
    return std::nullopt;
  Fit fit(profile, columns);
  if (!fit.Run()) return std::nullopt;
  const StepFit first = fit.First();
  if (!(std::abs(first.column - columns.front()) <= kFarthest)) return std::nullopt;
  if (!fit.Sees()) return std::nullopt;
  const double last_column = profile.first_column + static_cast<double>(profile.levels.size()) - 1;
  if (first.column < profile.first_column || first.column > last_column) return std::nullopt;
  return first;
}

}  // namespace scan_image_slam
