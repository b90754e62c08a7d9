#include "plain_world.h"
#include "scan_image_slam/core/simulation/camera_simulator.h"

#include <cmath>
#include <optional>

#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>

namespace scan_image_slam {
namespace {

/// Pixel of a point of the world by OpenCV's own projection, which the simulator does not use.
Eigen::Vector2d Project(const CameraSimulatorOptions& options, const Pose2& world_from_base,
                        const Eigen::Vector3d& point) {
  const CameraLens lens = TrueLens(options);
  const Eigen::Vector2d in_base = world_from_base.Inverse() * Eigen::Vector2d(point.head<2>());
  const Eigen::Vector3d in_camera =
      options.mount.Transform().inverse() * Eigen::Vector3d(in_base.x(), in_base.y(), point.z());
  const Eigen::Vector3d optical = BodyFromOptical().transpose() * in_camera;
  const cv::Matx33d k(lens.fx, 0, lens.cx, 0, lens.fy, lens.cy, 0, 0, 1);
  const std::vector<double> d(lens.distortion.begin(), lens.distortion.end());
  std::vector<cv::Point2d> pixels;
  cv::projectPoints(std::vector<cv::Point3d>{{optical.x(), optical.y(), optical.z()}},
                    cv::Vec3d(0, 0, 0), cv::Vec3d(0, 0, 0), k, d, pixels);
  return {pixels[0].x, pixels[0].y};
}

/// Where an edge lies near `guess` along a row or a column: the mean of the places where the grey
/// value changes, weighted by the change. Nothing if it hardly changes.
std::optional<double> FindEdge(const cv::Mat& image, int line, double guess, bool along_row) {
  const auto value = [&](int i) {
    return static_cast<double>(along_row ? image.at<std::uint8_t>(line, i)
                                         : image.at<std::uint8_t>(i, line));
  };
  double change = 0.0;
  double moment = 0.0;
  const int middle = static_cast<int>(std::lround(guess));
  for (int i = middle - 5; i < middle + 5; ++i) {
    change += value(i + 1) - value(i);
    moment += (value(i + 1) - value(i)) * (i + 0.5);
  }
  if (std::abs(change) < 20.0) return std::nullopt;
  return moment / change;
}

/// Compares the upright line at (x, y) of the world with its image, in all rows where it is seen.
/// Returns the largest error [px], and how many rows were compared.
struct EdgeError {
  double largest = 0.0;
  int rows = 0;
};
EdgeError CompareUpright(const cv::Mat& image, const CameraSimulatorOptions& options,
                         const Pose2& pose, const Eigen::Vector2d& at, double bottom, double top) {
  EdgeError error;
  int last_row = -1;
  for (double z = bottom; z <= top; z += 0.002) {
    // Heights whose image lies in the middle of a row, to a hundredth of a pixel or so.
    const Eigen::Vector2d pixel = Project(options, pose, {at.x(), at.y(), z});
    const int row = static_cast<int>(std::lround(pixel.y()));
    if (row == last_row || std::abs(pixel.y() - row) > 0.25) continue;
    if (row < 2 || row > image.rows - 3 || pixel.x() < 8 || pixel.x() > image.cols - 9) continue;
    last_row = row;
    const Eigen::Vector2d next = Project(options, pose, {at.x(), at.y(), z + 0.01});
    const double slant = (next.x() - pixel.x()) / (next.y() - pixel.y());
    const double expected = pixel.x() + slant * (row - pixel.y());
    const std::optional<double> seen = FindEdge(image, row, expected, true);
    EXPECT_TRUE(seen.has_value()) << "row " << row;
    if (!seen) continue;
    error.largest = std::max(error.largest, std::abs(*seen - expected));
    ++error.rows;
  }
  return error;
}

TEST(CameraLens, ProjectsLikeOpenCvAndBack) {
  const CameraSimulatorOptions options = SharpCamera();
  const CameraLens lens = TrueLens(options);
  for (const double u : {3.0, 200.0, 630.0}) {
    for (const double v : {5.0, 240.0, 470.0}) {
      const Eigen::Vector3d ray = lens.Ray({u, v});
      EXPECT_NEAR((lens.Project(ray) - Eigen::Vector2d(u, v)).norm(), 0.0, 1e-8);
      const Eigen::Vector3d in_base = options.mount.Transform() * (BodyFromOptical() * (3.0 * ray));
      EXPECT_NEAR((Project(options, {}, in_base) - Eigen::Vector2d(u, v)).norm(), 0.0, 1e-6);
    }
  }
}

TEST(CameraLens, RefusesADistortionThatFoldsTheImage) {
  const World world = PlainRoom(4.0, 4.0);
  CameraSimulatorOptions options = SharpCamera();
  options.k1 = -0.9;
  EXPECT_THROW(CameraSimulator(world, options, 1, 0), std::invalid_argument);
}

TEST(CameraGeometry, RefusesToLookStraightDown) {
  const World world = PlainRoom(4.0, 4.0);
  CameraSimulatorOptions options = SharpCamera();
  options.mount.pitch = 1.0;
  EXPECT_THROW(CameraSimulator(world, options, 1, 0), std::invalid_argument);
}

/// A door painted on the wall at x = 6, between y = -0.3 and y = 0.6.
World WorldWithDoor() {
  World world = PlainRoom(12.0, 8.0);
  for (Wall& wall : world.walls) {
    wall.from -= Eigen::Vector2d(6.0, 4.0);
    wall.to -= Eigen::Vector2d(6.0, 4.0);
  }
  // The wall at x = 6 runs from y = -4: y = -0.3 is 3.7 m along.
  Decoration door{3.7, 4.6, {{3.7, 4.6, 0.0, 2.0, {60, 60, 60}, Material::kPlain, -1}}};
  world.faces[world.walls[1].face].decorations.push_back(door);
  return world;
}

class Attitude : public testing::TestWithParam<std::array<double, 3>> {};

TEST_P(Attitude, PaintedEdgesLieWhereTheyAreProjected) {
  World world = WorldWithDoor();
  for (Face& face : world.faces) face.colour = {200, 200, 200};
  CameraSimulatorOptions options = SharpCamera();
  options.mount.yaw = GetParam()[0];
  options.mount.pitch = GetParam()[1];
  options.mount.roll = GetParam()[2];
  CameraSimulator camera(world, options, 1, 0);
  const cv::Mat image = camera.Draw({2.6, 0.4, -0.13}, 0.0);
  const Pose2 pose{2.6, 0.4, -0.13};
  for (const double y : {-0.3, 0.6}) {
    const EdgeError error = CompareUpright(image, options, pose, {6.0, y}, 0.1, 1.9);
    EXPECT_GT(error.rows, 60) << "y = " << y;
    EXPECT_LT(error.largest, 0.05) << "y = " << y;
  }
}

INSTANTIATE_TEST_SUITE_P(CameraGeometry, Attitude,
                         testing::Values(std::array<double, 3>{0.0, 0.0, 0.0},
                                         std::array<double, 3>{0.0, 0.07, 0.015},
                                         std::array<double, 3>{0.2, 0.35, -0.12},
                                         std::array<double, 3>{-0.1, -0.15, 0.3}));

TEST(CameraGeometry, RolledByNinetyDegreesUprightLinesAreRows) {
  World world = WorldWithDoor();
  for (Face& face : world.faces) face.colour = {200, 200, 200};
  CameraSimulatorOptions options = SharpCamera();
  options.mount.pitch = 0.05;
  options.mount.roll = M_PI_2;
  CameraSimulator camera(world, options, 1, 0);
  const Pose2 pose{2.6, 0.4, -0.13};
  const cv::Mat image = camera.Draw(pose, 0.0);
  int compared = 0;
  for (double z = 0.3; z < 1.3; z += 0.003) {
    const Eigen::Vector2d pixel = Project(options, pose, {6.0, -0.3, z});
    const int column = static_cast<int>(std::lround(pixel.x()));
    if (std::abs(pixel.x() - column) > 0.05 || pixel.y() < 8 || pixel.y() > 471) continue;
    const std::optional<double> seen = FindEdge(image, column, pixel.y(), false);
    ASSERT_TRUE(seen.has_value());
    EXPECT_NEAR(*seen, pixel.y(), 0.1);
    ++compared;
  }
  EXPECT_GT(compared, 20);
}

TEST(CameraGeometry, EndsOfThingsLieWhereTheyAreProjected) {
  World world = EmptyWorld();
  AddPlainWall(world, {8.0, -9.0}, {8.0, 9.0}, 200.0);
  AddPlainWall(world, {4.0, -0.437}, {4.0, 0.518}, 80.0);
  const CameraSimulatorOptions options = SharpCamera();
  CameraSimulator camera(world, options, 1, 0);
  const Pose2 pose{1.0, 0.1, 0.08};
  const cv::Mat image = camera.Draw(pose, 0.0);
  for (const double y : {-0.437, 0.518}) {
    const EdgeError error = CompareUpright(image, options, pose, {4.0, y}, 0.6, 1.2);
    EXPECT_GT(error.rows, 60);
    EXPECT_LT(error.largest, 0.05);
  }
}

TEST(CameraGeometry, EdgesFarAwayAndSlantedAreInPlaceToo) {
  // A band on the side wall of a corridor, 9 to 15 m ahead: only a few pixels wide.
  World world = EmptyWorld();
  AddPlainWall(world, {0.0, -1.2}, {40.0, -1.2}, 200.0);
  AddPlainWall(world, {0.0, 1.2}, {40.0, 1.2}, 200.0);
  AddPlainWall(world, {40.0, -1.2}, {40.0, 1.2}, 200.0);
  Decoration band{9.0, 15.0, {{9.0, 15.0, 0.2, 2.4, {60, 60, 60}, Material::kPlain, -1}}};
  world.faces[0].decorations.push_back(band);
  const CameraSimulatorOptions options = SharpCamera();
  CameraSimulator camera(world, options, 1, 0);
  const cv::Mat image = camera.Draw({}, 0.0);
  for (const double x : {9.0, 15.0}) {
    const EdgeError error = CompareUpright(image, options, {}, {x, -1.2}, 0.4, 1.2);
    EXPECT_GT(error.rows, 10) << x;
    EXPECT_LT(error.largest, 0.05) << x;
  }
}

TEST(CameraGeometry, TopEdgesLieAtTheirHeight) {
  World world = WorldWithDoor();
  for (Face& face : world.faces) face.colour = {200, 200, 200};
  CameraSimulatorOptions options = SharpCamera();
  options.mount.pitch = -0.1;
  CameraSimulator camera(world, options, 1, 0);
  const Pose2 pose{2.0, 0.1, 0.0};
  const cv::Mat image = camera.Draw(pose, 0.0);
  const Eigen::Vector2d pixel = Project(options, pose, {6.0, 0.15, 2.0});
  const std::optional<double> seen =
      FindEdge(image, static_cast<int>(std::lround(pixel.x())), pixel.y(), false);
  ASSERT_TRUE(seen.has_value());
  EXPECT_NEAR(*seen, pixel.y(), 0.15);
}

TEST(CameraGeometry, NearThingsHideFarOnesAndOnlyTheirOwnHeight) {
  World world = EmptyWorld();
  AddPlainWall(world, {8.0, -9.0}, {8.0, 9.0}, 200.0);
  AddPlainWall(world, {4.0, -1.0}, {4.0, 1.0}, 80.0);
  world.walls[1].bottom = 0.4;
  world.walls[1].top = 0.7;
  const CameraSimulatorOptions options = SharpCamera();
  CameraSimulator camera(world, options, 1, 0);
  const cv::Mat image = camera.Draw({}, 0.0);
  const double shade = 0.84 + 0.16 * 0.6;
  const auto grey_at = [&](double x, double z) {
    const Eigen::Vector2d pixel = Project(options, {}, {x, 0.0, z});
    return static_cast<double>(image.at<std::uint8_t>(static_cast<int>(std::lround(pixel.y())),
                                                      static_cast<int>(std::lround(pixel.x()))));
  };
  EXPECT_NEAR(grey_at(4.0, 0.55), 80.0 * shade, 1.0);
  EXPECT_NEAR(grey_at(8.0, 1.5), 200.0 * shade, 1.0);
  EXPECT_NEAR(grey_at(8.0, 0.1), 200.0 * shade, 1.0);
  EXPECT_NEAR(grey_at(2.0, 0.0), 100.0, 1.0);
  EXPECT_NEAR(grey_at(7.0, 2.6), 220.0, 1.0);
}

TEST(CameraGeometry, CalibrationErrorsChangeOnlyWhatIsPublished) {
  CameraSimulatorOptions options = SharpCamera();
  options.calibration_focal_error = 0.01;
  options.calibration_yaw_error = 0.02;
  EXPECT_NEAR(CalibratedLens(options).fx, 1.01 * TrueLens(options).fx, 1e-9);
  EXPECT_NEAR(CalibratedMount(options).yaw, options.mount.yaw + 0.02, 1e-12);
  const World world = WorldWithDoor();
  CameraSimulator wrong(world, options, 1, 0);
  CameraSimulator right(world, SharpCamera(), 1, 0);
  EXPECT_EQ(cv::norm(wrong.Draw({2.6, 0.4, 0.0}, 0.0), right.Draw({2.6, 0.4, 0.0}, 0.0)), 0.0);
}

}  // namespace
}  // namespace scan_image_slam
