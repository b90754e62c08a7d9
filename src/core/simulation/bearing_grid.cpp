#include "scan_image_slam/core/simulation/bearing_grid.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <opencv2/imgproc.hpp>

namespace scan_image_slam {
namespace {

/// Size of a cell of the grid in pixels where they are finest. Columns as wide as a pixel, each the
/// mean over its width, move upright edges by a few hundredths of a pixel only.
constexpr double kColumnWidth = 1.0;
constexpr double kRowHeight = 1.1;
constexpr int kMargin = 3;       // columns and rows beyond the image
constexpr double kBeside = 1e3;  // tangent of what is not ahead

/// Tangent of the bearing, and slope, of every pixel.
struct Directions {
  cv::Mat1d tangent;
  cv::Mat1d slope;
};

Directions PixelDirections(const CameraLens& lens, const MountPose& mount) {
  MountPose tilt = mount;
  tilt.yaw = 0.0;
  const Eigen::Matrix3d level_from_optical = tilt.Rotation() * BodyFromOptical();
  Directions directions{cv::Mat1d(lens.height, lens.width), cv::Mat1d(lens.height, lens.width)};
  for (int v = 0; v < lens.height; ++v) {
    for (int u = 0; u < lens.width; ++u) {
      const Eigen::Vector3d ray =
          level_from_optical * lens.Ray({static_cast<double>(u), static_cast<double>(v)});
      directions.tangent(v, u) = ray.x() > 0.0 ? ray.y() / ray.x() : kBeside;
      directions.slope(v, u) = ray.z() / ray.head<2>().norm();
    }
  }
  return directions;
}

/// The smallest change over one pixel, in the direction in which it is largest; nearly everywhere.
double FinestStep(const cv::Mat1d& values) {
  std::vector<double> steps;
  for (int v = 0; v + 1 < values.rows; v += 4) {
    for (int u = 0; u + 1 < values.cols; u += 4) {
      steps.push_back(std::hypot(values(v, u + 1) - values(v, u), values(v + 1, u) - values(v, u)));
    }
  }
  const auto few = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 10);
  std::nth_element(steps.begin(), few, steps.end());
  return *few;
}

void RequireLevel(double slope_min, double slope_max, double tangent_min, double tangent_max) {
  constexpr double kSteepest = 3.73;  // tan(75 deg)
  constexpr double kWidest = 5.68;    // tan(80 deg)
  if (slope_max > kSteepest || slope_min < -kSteepest) {
    throw std::invalid_argument("the camera looks too far up or down (75 degrees at most)");
  }
  if (tangent_max > kWidest || tangent_min < -kWidest) {
    throw std::invalid_argument("the camera's view is too wide (80 degrees to a side at most)");
  }
}

}  // namespace

BearingView MakeBearingView(const CameraLens& lens, const MountPose& mount) {
  const Directions directions = PixelDirections(lens, mount);
  double tangent_min = 0.0;
  double tangent_max = 0.0;
  double slope_min = 0.0;
  double slope_max = 0.0;
  cv::minMaxLoc(directions.tangent, &tangent_min, &tangent_max);
  cv::minMaxLoc(directions.slope, &slope_min, &slope_max);
  RequireLevel(slope_min, slope_max, tangent_min, tangent_max);

  BearingView view;
  BearingGrid& grid = view.grid;
  grid.tangent_step = kColumnWidth * FinestStep(directions.tangent);
  grid.tangent_min = tangent_min - kMargin * grid.tangent_step;
  grid.columns =
      static_cast<int>((tangent_max - tangent_min) / grid.tangent_step) + 2 * kMargin + 1;
  grid.slope_step = kRowHeight * FinestStep(directions.slope);
  grid.slope_min = slope_min - kMargin * grid.slope_step;
  grid.rows = static_cast<int>((slope_max - slope_min) / grid.slope_step) + 2 * kMargin + 1;

  // The first cell's middle is index 0 for cv::remap, half a cell from its border.
  const cv::Mat1f x((directions.slope - grid.slope_min) / grid.slope_step - 0.5);
  const cv::Mat1f y((directions.tangent - grid.tangent_min) / grid.tangent_step - 0.5);
  cv::convertMaps(x, y, view.map, view.map_fraction, CV_16SC2);
  return view;
}

}  // namespace scan_image_slam
