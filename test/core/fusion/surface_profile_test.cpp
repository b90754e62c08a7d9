#include "scan_image_slam/core/fusion/surface_profile.h"

#include "support_fusion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

using Column = SurfaceProfile::Column;

/// A camera that sees 28 degrees to each side; a column is 0.19 degrees.
BearingImage ImageFrom(double x, double y, double yaw = 0.0) {
  return BearingImage(CameraModel(PinholeCamera()), CameraView{{x, y, 0.5}, yaw}.FromOptical());
}

/// What a laser at the origin measures, with one beam for each bearing.
template <typename RangeAt>
FusedModel Sweep(double first_degrees, double last_degrees, double step_degrees, RangeAt range) {
  FusedModel model;
  const int count =
      1 + static_cast<int>(std::lround((last_degrees - first_degrees) / step_degrees));
  for (int i = 0; i < count; ++i) {
    ModelBeam beam;
    beam.bearing = (first_degrees + i * step_degrees) * kDegree;
    beam.range = range(beam.bearing);
    if (beam.hit()) {
      beam.point = beam.range * Eigen::Vector2d(std::cos(beam.bearing), std::sin(beam.bearing));
    }
    model.beams.push_back(beam);
  }
  return model;
}

double WallAtTwo(double bearing) { return 2.0 / std::cos(bearing); }

/// A wall `depth` ahead of the camera. A hit counts for its whole column, so half a column is as
/// good as it gets.
void ExpectWall(const SurfaceProfile& profile, const BearingImage& image, double depth) {
  for (int c = 0; c < image.columns(); ++c) {
    const double angle = std::abs(std::remainder(image.Bearing(c), M_PI));
    const double distance = depth / std::cos(angle);
    const double half_column = depth / std::cos(angle + 0.51 * image.step()) - distance;
    EXPECT_NEAR(profile.columns[c].distance, distance, half_column) << c;
  }
}

Column ColumnAt(const SurfaceProfile& profile, const BearingImage& image, double bearing) {
  return profile.columns[std::lround(image.Column(bearing))];
}

TEST(SurfaceProfile, WithoutHitsThereIsNoSurface) {
  const BearingImage image = ImageFrom(0, 0);
  const FusedModel model = Sweep(-40, 40, 1, [](double) { return std::nan(""); });
  const SurfaceProfile profile = ProfileOf(model, image);
  ASSERT_EQ(profile.columns.size(), static_cast<std::size_t>(image.columns()));
  for (const Column& column : profile.columns) {
    EXPECT_EQ(column.distance, 0.0);
    EXPECT_EQ(column.beam, -1);
  }
}

TEST(SurfaceProfile, AWallIsStraightBetweenTheBeams) {
  const BearingImage image = ImageFrom(0, 0);
  const SurfaceProfile profile = ProfileOf(Sweep(-40, 40, 1, WallAtTwo), image);
  ExpectWall(profile, image, 2.0);
}

TEST(SurfaceProfile, TheBeamIsTheNearestInBearing) {
  const BearingImage image = ImageFrom(0, 0);
  const FusedModel model = Sweep(-40, 40, 1, WallAtTwo);
  const SurfaceProfile profile = ProfileOf(model, image);
  for (int c = 0; c < image.columns(); ++c) {
    const double off = model.beams[profile.columns[c].beam].bearing - image.Bearing(c);
    EXPECT_LE(std::abs(off), 0.5 * kDegree + 1e-9) << c;
  }
}

TEST(SurfaceProfile, DistancesAreFromTheCamera) {
  const BearingImage image = ImageFrom(0.5, 0.3);
  const SurfaceProfile profile = ProfileOf(Sweep(-60, 60, 0.5, WallAtTwo), image);
  ExpectWall(profile, image, 1.5);
}

TEST(SurfaceProfile, BeamsBehindTheCameraAreNotInIt) {
  PaintedWorld room;  // 2 m to the front, 1 m to the back
  room.AddWall({2, -9}, {2, 9});
  room.AddWall({-1, -9}, {-1, 9});
  const auto range = [&](double bearing) { return room.Range({0, 0}, bearing); };
  const FusedModel model = Sweep(-179.5, 179.5, 1, range);
  const BearingImage front = ImageFrom(0, 0);
  ExpectWall(ProfileOf(model, front), front, 2.0);
}

TEST(SurfaceProfile, ACameraThatLooksBackSeesWhatIsThere) {
  const auto range = [](double bearing) { return -1.0 / std::cos(bearing); };
  const FusedModel model = Sweep(120, 240, 1, range);  // across pi
  const BearingImage back = ImageFrom(0, 0, M_PI);
  ExpectWall(ProfileOf(model, back), back, 1.0);
}

TEST(SurfaceProfile, AFullTurnHasNoSeam) {
  PaintedWorld room;
  room.AddWall({2, -9}, {2, 9});
  const auto range = [&](double bearing) { return room.Range({0, 0}, bearing); };
  const BearingImage image(CameraModel(PinholeCamera(640, 480, 600.0)), CameraView().FromOptical());
  ExpectWall(ProfileOf(Sweep(0.5, 359.5, 1, range), image), image, 2.0);
}

TEST(SurfaceProfile, ACutIsNotASurface) {
  PaintedWorld corridor;  // 2 m wide, its end is 9 m ahead
  corridor.AddWall({-9, 1}, {9, 1});
  corridor.AddWall({9, 1}, {9, -1});
  corridor.AddWall({9, -1}, {-9, -1});
  const auto range = [&](double bearing) { return corridor.Range({0, 0}, bearing); };
  FusedModel model = Sweep(0.5, 10.5, 1, range);
  const FusedModel right = Sweep(349.5, 359.5, 1, range);
  model.beams.insert(model.beams.end(), right.beams.begin(), right.beams.end());
  const BearingImage image = ImageFrom(0, 0);
  const Column ahead = ColumnAt(ProfileOf(model, image), image, 0.5 * kDegree);
  EXPECT_NEAR(ahead.distance, 9.0, 0.01);
}

/// A wall at 2 m whose beams at the bearings of `missing` [degrees] give no range.
SurfaceProfile WithMissingBeams(const std::vector<int>& missing, const BearingImage& image) {
  return ProfileOf(Sweep(-40, 40, 1,
                         [&](double bearing) {
                           const int degrees = static_cast<int>(std::lround(bearing / kDegree));
                           const bool gone =
                               std::find(missing.begin(), missing.end(), degrees) != missing.end();
                           return gone ? std::nan("") : WallAtTwo(bearing);
                         }),
                   image);
}

TEST(SurfaceProfile, BridgesTwoMissingBeamsButNotThree) {
  const BearingImage image = ImageFrom(0, 0);
  const double middle = 0.5 * kDegree;
  EXPECT_NEAR(ColumnAt(WithMissingBeams({0, 1}, image), image, middle).distance, WallAtTwo(middle),
              1e-3);
  EXPECT_EQ(ColumnAt(WithMissingBeams({0, 1, 2}, image), image, 1.0 * kDegree).distance, 0.0);
}

TEST(SurfaceProfile, AGrazingWallIsOneSurfaceUpToASlopeOf14) {
  const BearingImage image = ImageFrom(0, 0);
  const double across = 2.0 * kDegree;       // between two beams of two degrees at 1 m
  for (const double slope : {13.5, 14.5}) {  // beyond, the nearer one reaches over the gap
    const FusedModel model =
        Sweep(-1, 1, 2, [&](double bearing) { return bearing < 0.0 ? 1.0 : 1.0 + slope * across; });
    const double distance = ColumnAt(ProfileOf(model, image), image, 0.0).distance;
    EXPECT_EQ(distance > 1.05, slope < 14.0) << distance;
  }
}

TEST(SurfaceProfile, AHitThatStandsAloneReachesTwoColumnsFar) {
  const BearingImage image = ImageFrom(0, 0);
  const double degrees = image.Bearing(100.0) / kDegree;
  const FusedModel model = Sweep(degrees, degrees, 1, [](double) { return 3.0; });
  const SurfaceProfile profile = ProfileOf(model, image);
  for (int c = 0; c < image.columns(); ++c) {
    const bool covered = std::abs(c - 100) <= 2;
    EXPECT_NEAR(profile.columns[c].distance, covered ? 3.0 : 0.0, 1e-12) << c;
    EXPECT_EQ(profile.columns[c].beam, covered ? 0 : -1) << c;
  }
}

}  // namespace
}  // namespace scan_image_slam
