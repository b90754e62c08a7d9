#include "scan_image_slam/core/matching/surface.h"

#include "support_rooms.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

const SurfaceOptions kOptions;
const RangeNoise kNoise;

std::vector<SurfacePoint> SurfaceOf(const Room& room, const TestLaser& laser = TestLaser(),
                                    const Pose2& pose = Pose2(), TestRandom* random = nullptr) {
  return EstimateSurface(ModelOf(room, pose, 0, laser, random), kOptions, kNoise);
}

double AngleBetween(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return std::acos(std::clamp(a.dot(b), -1.0, 1.0));
}

/// A model of bare beams, 1 degree apart; range 0 stands for no hit.
FusedModel ModelOfRanges(const std::vector<double>& ranges) {
  FusedModel model;
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    ModelBeam beam;
    beam.bearing = static_cast<double>(i) * M_PI / 180.0;
    beam.range = ranges[i] > 0.0 ? ranges[i] : std::numeric_limits<double>::quiet_NaN();
    beam.time_offset = 0.001 * static_cast<double>(i);
    if (beam.hit()) {
      beam.point = beam.range * Eigen::Vector2d(std::cos(beam.bearing), std::sin(beam.bearing));
    }
    model.beams.push_back(beam);
  }
  return model;
}

TEST(EstimateSurface, CopiesTheHitsInOrder) {
  FusedModel model = ModelOfRanges({1.0, 0.0, 2.0});
  model.base_from_laser = {0.5, 0.0, 0.0};
  model.beams[0].point = {1.5, 0.0};
  model.beams[2].point = {0.5, 2.0};
  const auto points = EstimateSurface(model, kOptions, kNoise);
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[0].range, 1.0);
  EXPECT_EQ(points[1].range, 2.0);
  EXPECT_EQ(points[1].time_offset, 0.002);
  EXPECT_EQ(points[1].point, Eigen::Vector2d(0.5, 2.0));
  EXPECT_NEAR((points[0].ray - Eigen::Vector2d(1.0, 0.0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((points[1].ray - Eigen::Vector2d(0.0, 1.0)).norm(), 0.0, 1e-12);
}

TEST(EstimateSurface, HasNoPointsWithoutHits) {
  EXPECT_TRUE(EstimateSurface(FusedModel(), kOptions, kNoise).empty());
  EXPECT_TRUE(EstimateSurface(ModelOfRanges({0, 0, 0, 0}), kOptions, kNoise).empty());
}

TEST(EstimateSurface, FindsTheNormalOfAWallFromBothSides) {
  const Room wall{{{2.0, -3.0}, {2.0, 3.0}}};
  for (const double x : {0.0, 4.0}) {
    const auto points = SurfaceOf(wall, TestLaser(), {x, 0.0, 0.0});
    ASSERT_GT(points.size(), 100u);
    for (const SurfacePoint& p : points) {
      EXPECT_NEAR(p.normal.x(), x < 2.0 ? -1.0 : 1.0, 1e-9);  // towards the laser
      EXPECT_NEAR(p.normal.y(), 0.0, 1e-7);
    }
  }
}

TEST(EstimateSurface, FollowsASlantedWallSeenFromATurnedBase) {
  const Pose2 pose{0.3, -0.2, 0.8};
  const Eigen::Vector2d normal_in_room = Eigen::Vector2d(1.0, 2.0).normalized();
  const auto points = SurfaceOf({{{-4.0, 0.0}, {2.0, -3.0}}}, TestLaser(), pose);
  ASSERT_GT(points.size(), 100u);
  for (const SurfacePoint& p : points) {
    EXPECT_LT(AngleBetween(RigidTransform2(pose).Rotate(p.normal), normal_in_room), 1e-6);
  }
}

TEST(EstimateSurface, FollowsAGrazingWall) {
  // Seen from 0.3 m beside it, the wall is hit at up to 84 degrees of incidence 3 m ahead.
  const auto points = SurfaceOf({{{-3.0, 0.3}, {3.0, 0.3}}});
  int far = 0;
  for (const SurfacePoint& p : points) {
    ASSERT_TRUE(p.has_normal()) << p.point.transpose();
    EXPECT_NEAR(p.normal.y(), -1.0, 1e-9);
    far += std::abs(p.point.x()) > 2.5 ? 1 : 0;
  }
  EXPECT_GT(far, 4);
}

TEST(EstimateSurface, GivesUpOnAWallTooGrazing) {
  SurfaceOptions options = kOptions;
  options.max_incidence = 1.0;
  const FusedModel model = ModelOf({{{-3.0, 0.3}, {3.0, 0.3}}}, Pose2(), 0, TestLaser());
  for (const SurfacePoint& p : EstimateSurface(model, options, kNoise)) {
    const double incidence = std::acos(std::min(1.0, std::abs(p.ray.y())));
    // One beam of 0.5 degrees changes the incidence by as much, two on each side by 0.035 rad.
    if (std::abs(incidence - 1.0) < 0.035) continue;
    EXPECT_EQ(p.has_normal(), incidence < 1.0) << p.point.transpose();
  }
}

TEST(EstimateSurface, LeavesIsolatedPointsWithoutANormal) {
  for (const SurfacePoint& p :
       EstimateSurface(ModelOfRanges({0, 2, 0, 0, 0, 2, 2, 0, 0, 0, 0, 2}), kOptions, kNoise)) {
    EXPECT_FALSE(p.has_normal());
  }
}

TEST(EstimateSurface, BridgesTwoLostBeamsButNotThree) {
  const auto two = EstimateSurface(ModelOfRanges({2, 0, 0, 2, 0, 0, 2}), kOptions, kNoise);
  const auto three = EstimateSurface(ModelOfRanges({2, 0, 0, 0, 2, 0, 0, 0, 2}), kOptions, kNoise);
  EXPECT_TRUE(std::all_of(two.begin(), two.end(), [](auto& p) { return p.has_normal(); }));
  EXPECT_TRUE(std::none_of(three.begin(), three.end(), [](auto& p) { return p.has_normal(); }));
}

TEST(EstimateSurface, DoesNotBridgeAJumpOfTheRange) {
  // A pillar's face at 1.9 m before a wall at 2.9 m: a line across the jump would be slanted.
  const auto points = SurfaceOf({{{1.9, -0.4}, {1.9, 0.4}}, {{2.9, -3.0}, {2.9, 3.0}}});
  ASSERT_GT(points.size(), 60u);
  for (const SurfacePoint& p : points) {
    if (!p.has_normal()) continue;
    EXPECT_NEAR(p.normal.x(), -1.0, 1e-9) << p.point.transpose();
  }
}

TEST(EstimateSurface, TakesTwoNeighboursWhereBeamsAreFarApart) {
  // 1 degree at 20 m is 0.35 m, more than twice the radius.
  TestLaser laser;
  laser.beams = 360;
  const auto points = SurfaceOf({{{20.0, -3.0}, {20.0, 3.0}}}, laser);
  ASSERT_GT(points.size(), 10u);
  for (const SurfacePoint& p : points) EXPECT_NEAR(p.normal.x(), -1.0, 1e-9);
}

/// Largest angle between the normals of a right-angled corner and the walls they lie on, of the
/// points at least `clear` from the corner.
double CornerSmear(double range_stddev, double clear) {
  RangeNoise noise;
  noise.range_stddev = range_stddev;
  const Room corner{{{2.0, -1.0}, {2.0, 1.0}}, {{2.0, 1.0}, {-1.0, 1.0}}};
  TestLaser laser;
  laser.beams = 2880;
  double worst = 0.0;
  for (const auto& p : EstimateSurface(ModelOf(corner, Pose2(), 0, laser), kOptions, noise)) {
    if (!p.has_normal() || (p.point - Eigen::Vector2d(2.0, 1.0)).norm() < clear) continue;
    const bool on_front_wall = p.point.x() > 1.999999;
    worst = std::max(worst, AngleBetween(p.normal, on_front_wall ? Eigen::Vector2d(-1.0, 0.0)
                                                                 : Eigen::Vector2d(0.0, -1.0)));
  }
  return worst;
}

TEST(EstimateSurface, DoesNotSmearACornerBeyondTheRadius) {
  EXPECT_LT(CornerSmear(0.02, kOptions.radius), 1e-6);
}

TEST(EstimateSurface, TakesOneSideOfACornerForAPreciseLaser) {
  // A line across the corner is accepted up to a scatter of 2 * 2 mm. Of L = 0.3 m on its own wall
  // and c on the other one, which may be seen twice as densely, it scatters by 2 c^3 / (3 L), so
  // c < 19 mm, and turns by (c^2 / 2) / (L^2 / 12) < 0.025 rad.
  EXPECT_LT(CornerSmear(0.002, 0.02), 0.025);
}

TEST(EstimateSurface, DoesNotSmearACornerWithTheDefaultOptions) {
  EXPECT_LT(CornerSmear(0.02, 0.05), 10.0 * M_PI / 180.0);
}

TEST(EstimateSurface, TellsHowWellTheNormalIsKnown) {
  // Without noise the scatter is taken to be the laser's own, and the error of the direction is
  // that scatter over the spread of the points along the wall.
  const auto points = SurfaceOf({{{2.0, -1.0}, {2.0, 1.0}}});
  const SurfacePoint& middle = points[points.size() / 2];
  std::vector<double> y;
  for (const SurfacePoint& p : points) {
    if (std::abs(p.point.y() - middle.point.y()) < 0.15) y.push_back(p.point.y());
  }
  double mean = 0.0, spread = 0.0;
  for (const double v : y) mean += v / static_cast<double>(y.size());
  for (const double v : y) spread += (v - mean) * (v - mean);
  const double across = std::pow(0.02 * middle.ray.x(), 2) + std::pow(0.001 * middle.range, 2);
  EXPECT_NEAR(middle.angle_variance, across / spread, 1e-6 * across / spread);
}

TEST(EstimateSurface, IsAsWrongAsItSays) {
  // Squared errors of the normals over their variance average to 1. Of the 2 m looked at, 0.3 m
  // make one line, so 40 scans hold about 270 independent ones: three deviations of the mean are 3
  // * sqrt(2 / 270) = 0.26.
  TestRandom random(5);
  TestLaser laser;
  laser.range_stddev = 0.02;
  double sum = 0.0;
  int count = 0;
  for (int i = 0; i < 40; ++i) {
    for (const auto& p : SurfaceOf({{{2.0, -2.0}, {2.0, 2.0}}}, laser, Pose2(), &random)) {
      if (!p.has_normal() || std::abs(p.point.y()) > 1.0) continue;
      const double error = AngleBetween(p.normal, {-1.0, 0.0});
      sum += error * error / p.angle_variance;
      ++count;
    }
  }
  EXPECT_GT(count, 4000);
  EXPECT_NEAR(sum / count, 1.0, 0.26);
}

TEST(RangeNoise, AddsTheNoiseAlongAndAcrossTheRay) {
  const RangeNoise noise{0.03, 0.002};
  EXPECT_DOUBLE_EQ(noise.VarianceAcross(5.0, 0.0), 1e-4);
  EXPECT_NEAR(noise.VarianceAcross(5.0, -0.5), 0.015 * 0.015 + 1e-4, 1e-18);
}

/// The same scan in a mirror: left is right, and the first beam the last.
FusedModel Mirrored(FusedModel model) {
  std::reverse(model.beams.begin(), model.beams.end());
  for (ModelBeam& beam : model.beams) {
    beam.bearing = -beam.bearing;
    beam.point.y() = -beam.point.y();
  }
  return model;
}

TEST(EstimateSurface, DoesNotKnowLeftFromRight) {
  TestRandom random(3);
  TestLaser laser;
  laser.range_stddev = 0.03;
  const FusedModel scan = ModelOf(Rectangle(-2, -1.5, 3, 2.5) + Rectangle(1.2, 0.4, 1.8, 0.9),
                                  Pose2{0.1, 0.2, 0.3}, 0, laser, &random);
  const auto points = EstimateSurface(scan, kOptions, kNoise);
  const auto mirrored = EstimateSurface(Mirrored(scan), kOptions, kNoise);
  ASSERT_EQ(points.size(), mirrored.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const SurfacePoint& other = mirrored[points.size() - 1 - i];
    const Eigen::Vector2d back(other.normal.x(), -other.normal.y());
    EXPECT_NEAR((points[i].normal - back).norm(), 0.0, 1e-9) << i;
    EXPECT_NEAR(points[i].angle_variance, other.angle_variance, 1e-9) << i;
  }
}

}  // namespace
}  // namespace scan_image_slam
