#include "table1_pictures.h"

#include "picture_file.h"
#include "scan_image_slam/core/mapping/map_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <opencv2/imgproc.hpp>

namespace scan_image_slam {
namespace {

constexpr double kMargin = 0.5;  // around the walls [m]
constexpr int kLargestSide = 700;

const cv::Scalar kPaper(255, 255, 255);
const cv::Scalar kTruthColour(0, 0, 0);
const cv::Scalar kCoreSlamColour(40, 40, 220);

/// What stands at the laser's height, as a map.
MapImage TrueMap(const Scenario& scenario) {
  Eigen::Array2d low = Eigen::Array2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Array2d high = -low;
  for (const Wall& wall : scenario.world.walls) {
    low = low.min(wall.from.array()).min(wall.to.array());
    high = high.max(wall.from.array()).max(wall.to.array());
  }
  MapImage map;
  map.resolution = kPixel;
  map.origin_x = low.x() - kMargin;
  map.origin_y = low.y() - kMargin;
  map.width = static_cast<int>(std::ceil((high.x() - low.x() + 2.0 * kMargin) / kPixel));
  map.height = static_cast<int>(std::ceil((high.y() - low.y() + 2.0 * kMargin) / kPixel));
  cv::Mat cells(map.height, map.width, CV_8U, cv::Scalar(0));
  const auto cell = [&](const Eigen::Vector2d& p) {
    return cv::Point(static_cast<int>((p.x() - map.origin_x) / kPixel),
                     static_cast<int>((p.y() - map.origin_y) / kPixel));
  };
  for (const Wall& wall : scenario.world.walls) {
    const double height = scenario.laser.mount.z;
    if (wall.bottom > height || wall.top < height) continue;
    cv::line(cells, cell(wall.from), cell(wall.to), cv::Scalar(70));
  }
  map.occupancy.assign(cells.begin<std::uint8_t>(), cells.end<std::uint8_t>());
  return map;
}

cv::Mat Panel(const MapImage& map, const std::string& name, const cv::Scalar& colour,
              const Trajectory& trajectory) {
  DrawnPath path{name, colour, {}};
  for (const StampedPose& p : trajectory) {
    // A way that leaves the picture is cut off, so that all panels have one size.
    const double x = std::clamp(p.pose.x, map.origin_x + kPixel,
                                map.origin_x + (map.width - 1) * map.resolution);
    const double y = std::clamp(p.pose.y, map.origin_y + kPixel,
                                map.origin_y + (map.height - 1) * map.resolution);
    path.poses.push_back({x, y, p.pose.theta});
  }
  const cv::Mat drawn = DrawMap(map, {path}, kLargestSide);
  cv::Mat panel;
  constexpr int kFrame = 3;
  cv::copyMakeBorder(drawn, panel, kFrame, kFrame, kFrame, kFrame, cv::BORDER_CONSTANT,
                     cv::Scalar::all(120));
  return panel;
}

std::string NameOf(const Table1Estimate& estimate) {
  const std::string name = estimate.row.method == "coreslam" ? "CoreSLAM" : "proposed";
  return name + cv::format(", %.3f m", estimate.row.error);
}

}  // namespace

void WriteFigure6(const std::string& path, const Scenario& scenario, const Table1Result& result) {
  const MapImage map = TrueMap(scenario);
  std::vector<cv::Mat> panels = {Panel(map, "truth", kTruthColour, result.truth)};
  const Table1Estimate& core_slam = result.estimates[0];
  const Table1Estimate& proposed = result.estimates[1];
  panels.push_back(Panel(map, NameOf(proposed), kEstimateColour, proposed.trajectory));
  panels.push_back(Panel(map, NameOf(core_slam), kCoreSlamColour, core_slam.trajectory));
  cv::Mat picture;
  if (map.width > 2 * map.height) {
    int width = 0;
    for (const cv::Mat& panel : panels) width = std::max(width, panel.cols);
    for (cv::Mat& panel : panels) {
      cv::copyMakeBorder(panel, panel, 0, 0, 0, width - panel.cols, cv::BORDER_CONSTANT, kPaper);
    }
    cv::vconcat(panels, picture);
  } else {
    cv::hconcat(panels, picture);
  }
  WritePicture(path, picture);
}

}  // namespace scan_image_slam
