#include "scan_image_slam/core/geometry/line_fit.h"

#include "core/geometry/pose_near.h"

#include <cmath>
#include <vector>

#include <Eigen/SVD>
#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

using Points = std::vector<Eigen::Vector2d>;

PointSums SumsOf(const Points& points) {
  PointSums sums;
  for (const Eigen::Vector2d& p : points) sums = sums.Plus(p);
  return sums;
}

Line Fit(const Points& points) { return FitLine(SumsOf(points)); }

Points NoisyLine(Dice* dice, int count, const Eigen::Vector2d& near, double heading, double noise) {
  const Eigen::Vector2d along(std::cos(heading), std::sin(heading));
  const Eigen::Vector2d across(-along.y(), along.x());
  Points points;
  for (int i = 0; i < count; ++i) {
    points.push_back(near + dice->Between(-0.3, 0.3) * along +
                     dice->Between(-noise, noise) * across);
  }
  return points;
}

/// The same by the singular values of the centred points.
void ExpectAsBySvd(const Points& points, double relative) {
  Eigen::Vector2d centre(0, 0);
  for (const Eigen::Vector2d& p : points) centre += p / static_cast<double>(points.size());
  Eigen::MatrixX2d centred(points.size(), 2);
  for (std::size_t i = 0; i < points.size(); ++i) centred.row(i) = (points[i] - centre).transpose();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(centred, Eigen::ComputeThinV);
  const Eigen::Vector2d squares = svd.singularValues().array().square();
  const Line line = Fit(points);
  const double n = static_cast<double>(points.size());
  EXPECT_NEAR((line.centre - centre).norm(), 0.0, 1e-12 * (1.0 + centre.norm()));
  EXPECT_NEAR(line.normal.norm(), 1.0, 1e-12);
  EXPECT_NEAR(line.normal.dot(svd.matrixV().col(0)), 0.0, relative);
  EXPECT_NEAR(line.spread, squares[0], relative * squares[0]);
  EXPECT_NEAR(line.variance, squares[1] / (n - 2.0), relative * squares[0]);
}

TEST(FitLine, AgreesWithSingularValues) {
  Dice dice;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector2d near(dice.Between(-2, 2), dice.Between(-2, 2));
    ExpectAsBySvd(NoisyLine(&dice, 3 + i % 20, near, dice.Between(-M_PI, M_PI), 0.02), 1e-10);
  }
}

TEST(FitLine, StaysExactAtTheEndOfTheLasersReach) {
  Dice dice;
  for (int i = 0; i < 50; ++i) {
    ExpectAsBySvd(NoisyLine(&dice, 10, {70.0, -70.0}, dice.Between(-M_PI, M_PI), 0.02), 1e-7);
  }
}

TEST(FitLine, Horizontal) {
  const Line line = Fit({{0, 3}, {1, 3}, {2, 3}});
  EXPECT_EQ(line.centre, Eigen::Vector2d(1, 3));
  EXPECT_EQ(line.normal.cwiseAbs(), Eigen::Vector2d(0, 1));
  EXPECT_EQ(line.variance, 0.0);
  EXPECT_EQ(line.spread, 2.0);
}

TEST(FitLine, Vertical) {
  const Line line = Fit({{3, 0}, {3, 1}, {3, 2}});
  EXPECT_EQ(line.centre, Eigen::Vector2d(3, 1));
  EXPECT_EQ(line.normal.cwiseAbs(), Eigen::Vector2d(1, 0));
  EXPECT_EQ(line.variance, 0.0);
  EXPECT_EQ(line.spread, 2.0);
}

TEST(FitLine, TheTwoDiagonals) {
  const double r = std::sqrt(0.5);
  EXPECT_NEAR(std::abs(Fit({{0, 0}, {1, 1}, {2, 2}}).normal.dot(Eigen::Vector2d(r, -r))), 1, 1e-15);
  EXPECT_NEAR(std::abs(Fit({{0, 0}, {1, -1}, {2, -2}}).normal.dot(Eigen::Vector2d(r, r))), 1,
              1e-15);
}

TEST(FitLine, TheVarianceIsUnbiased) {
  // Squared distances across sum up to 4, along to 16; two parameters are fitted to four points.
  const Line line = Fit({{0, 1}, {0, -1}, {4, 1}, {4, -1}});
  EXPECT_EQ(line.variance, 2.0);
  EXPECT_EQ(line.spread, 16.0);
}

TEST(FitLine, PointsThatCoincideHaveNoNormal) {
  const Line line = Fit({{1, 2}, {1, 2}, {1, 2}});
  EXPECT_EQ(line.centre, Eigen::Vector2d(1, 2));
  EXPECT_EQ(line.normal, Eigen::Vector2d(0, 0));
  EXPECT_EQ(line.variance, 0.0);
  EXPECT_EQ(line.spread, 0.0);
}

TEST(FitLine, PointsThatCoincideHaveNoNormalWhereverTheyAre) {
  Dice dice;
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector2d p(dice.Between(-5, 5), dice.Between(-5, 5));
    EXPECT_EQ(Fit({p, p, p, p, p}).normal, Eigen::Vector2d(0, 0)) << p.transpose();
  }
}

TEST(PointSums, DifferencesAreTheSumsOfAStretch) {
  const Points points{{1, 2}, {3, -4}, {5, 6}, {-7, 8}};
  std::vector<PointSums> running(1);
  for (const Eigen::Vector2d& p : points) running.push_back(running.back().Plus(p));
  const PointSums stretch = running[3] - running[1];  // (3, -4) and (5, 6)
  EXPECT_EQ(stretch.n, 2.0);
  EXPECT_EQ(stretch.x, 8.0);
  EXPECT_EQ(stretch.y, 2.0);
  EXPECT_EQ(stretch.xx, 34.0);
  EXPECT_EQ(stretch.xy, 18.0);
  EXPECT_EQ(stretch.yy, 52.0);
}

}  // namespace
}  // namespace scan_image_slam
