#include "scan_image_slam/core/fusion/surface_profile.h"
#include "support_fusion.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

BearingImage ImageFrom(double x, double y) {
  return BearingImage(CameraModel(PinholeCamera()), CameraView{{x, y, 0.5}}.FromOptical());
}

/// Two walls across the line of sight: one at `near_x` on the left of a border, one at `far_x` on
/// its right, seen by a laser at the origin.
struct TwoWalls {
  double near_x = 1.0;
  double far_x = 3.0;
  double border = 0.0;  ///< bearing from the laser [rad]

  FusedModel Seen(double first, double step, int count) const {
    FusedModel model;
    for (int i = 0; i < count; ++i) {
      ModelBeam beam;
      beam.bearing = first + i * step;
      beam.range = (beam.bearing > border ? near_x : far_x) / std::cos(beam.bearing);
      beam.point = beam.range * Eigen::Vector2d(std::cos(beam.bearing), std::sin(beam.bearing));
      model.beams.push_back(beam);
    }
    return model;
  }
};

double DistanceAt(const SurfaceProfile& profile, const BearingImage& image, double bearing) {
  return profile.columns[std::lround(image.Column(bearing))].distance;
}

TEST(SurfaceBorder, TheNearerSurfaceReachesTwoColumnsIntoTheFartherOne) {
  const BearingImage image = ImageFrom(0, 0);
  // Two beams for each column; the last beam of the near wall is at the middle of column 150.
  const double step = 0.5 * image.step();
  const double last = image.Bearing(150.0);
  const FusedModel model =
      TwoWalls{1.0, 3.0, last - 0.25 * step}.Seen(last - 200 * step, step, 401);
  const SurfaceProfile profile = ProfileOf(model, image);
  for (int c = 145; c <= 155; ++c) {
    EXPECT_NEAR(profile.columns[c].distance, c <= 152 ? 1.0 : 3.0, 0.002) << c;
    EXPECT_EQ(model.beams[profile.columns[c].beam].range < 2.0, c <= 152) << c;
  }
}

TEST(SurfaceBorder, SurfacesOfNearlyTheSameDistanceKeepTheirColumns) {
  const BearingImage image = ImageFrom(0, 0);
  const double step = 0.5 * image.step();
  const double last = image.Bearing(150.0);
  const FusedModel model =
      TwoWalls{2.0, 2.08, last - 0.25 * step}.Seen(last - 200 * step, step, 401);
  const SurfaceProfile profile = ProfileOf(model, image);
  for (int c = 145; c <= 155; ++c) {
    EXPECT_NEAR(profile.columns[c].distance, c <= 150 ? 2.0 : 2.08, 0.002) << c;
  }
}

TEST(SurfaceBorder, ParallaxHidesTheFartherSurface) {
  // From the laser the near wall ends at (1, 0), the far one at (3, 0). From (0, 0.5) these are at
  // -26.6 and -9.5 degrees: between them the camera looks at both.
  const BearingImage image = ImageFrom(0, 0.5);
  FusedModel model = TwoWalls().Seen(-60.25 * kDegree, 0.5 * kDegree, 242);
  for (int order = 0; order < 2; ++order) {
    const SurfaceProfile profile = ProfileOf(model, image);
    for (const double degrees : {-25.0, -20.0, -12.0, 0.0, 20.0}) {
      const double bearing = degrees * kDegree;
      EXPECT_NEAR(DistanceAt(profile, image, bearing), 1.0 / std::cos(bearing), 0.01) << degrees;
    }
    std::reverse(model.beams.begin(), model.beams.end());
  }
}

TEST(SurfaceBorder, ParallaxOpensAGap) {
  // From (0, -0.5) the near wall ends at 26.6 degrees and the far one at 9.5.
  const BearingImage image = ImageFrom(0, -0.5);
  const SurfaceProfile profile =
      ProfileOf(TwoWalls().Seen(-60.25 * kDegree, 0.5 * kDegree, 242), image);
  EXPECT_NEAR(DistanceAt(profile, image, 8.5 * kDegree), 3.0 / std::cos(8.5 * kDegree), 0.02);
  EXPECT_EQ(DistanceAt(profile, image, 12.0 * kDegree), 0.0);
  EXPECT_EQ(DistanceAt(profile, image, 24.0 * kDegree), 0.0);
  EXPECT_GT(DistanceAt(profile, image, 27.5 * kDegree), 0.0);
}

TEST(SurfaceBorder, BetweenWideBeamsTheGapBelongsToTheNearerSurface) {
  const BearingImage image = ImageFrom(0, 0);
  const SurfaceProfile profile =
      ProfileOf(TwoWalls().Seen(-30.5 * kDegree, 1.0 * kDegree, 62), image);  // to 30.5 degrees
  for (const double degrees : {0.3, 0.0, -0.3}) {  // the beams beside are at 0.5 and -0.5
    EXPECT_NEAR(DistanceAt(profile, image, degrees * kDegree), 1.0, 0.1) << degrees;
  }
}

}  // namespace
}  // namespace scan_image_slam
