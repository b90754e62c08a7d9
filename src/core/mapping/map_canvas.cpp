#include "scan_image_slam/core/mapping/map_canvas.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace scan_image_slam {
namespace {

constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
const cv::Scalar kInk(40, 40, 40);

constexpr int kSubpixelBits = 4;
constexpr int kSubpixel = 1 << kSubpixelBits;

cv::Mat GreyCells(const MapImage& map) {
  cv::Mat cells(map.height, map.width, CV_8UC3);
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) {
      const int occupancy = map.occupancy[static_cast<std::size_t>(y) * map.width + x];
      const int grey = occupancy < 0 ? 205 : 254 - occupancy * 254 / 100;
      cells.at<cv::Vec3b>(map.height - 1 - y, x) = cv::Vec3b::all(static_cast<std::uint8_t>(grey));
    }
  }
  return cells;
}

}  // namespace

MapCanvas::MapCanvas(const MapImage& map, const std::vector<Eigen::Vector2d>& points,
                     int largest_side)
    : resolution_(map.resolution) {
  const Eigen::Vector2d origin(map.origin_x, map.origin_y);
  const Eigen::Vector2d margin(resolution_, resolution_);
  Eigen::Vector2d low = origin;
  Eigen::Vector2d high = origin + resolution_ * Eigen::Vector2d(map.width, map.height);
  for (const Eigen::Vector2d& point : points) {
    low = low.cwiseMin(point - margin);
    high = high.cwiseMax(point + margin);
  }
  left_ = static_cast<int>(std::ceil((origin.x() - low.x()) / resolution_));
  below_ = static_cast<int>(std::ceil((origin.y() - low.y()) / resolution_));
  low = origin - resolution_ * Eigen::Vector2d(left_, below_);
  const int width = static_cast<int>(std::ceil((high.x() - low.x()) / resolution_));
  const int height = static_cast<int>(std::ceil((high.y() - low.y()) / resolution_));
  cv::Mat cells(height, width, CV_8UC3, cv::Scalar::all(205));
  if (cells.empty()) return;
  if (map.width > 0) {
    GreyCells(map).copyTo(
        cells(cv::Rect(left_, height - below_ - map.height, map.width, map.height)));
  }
  scale_ = std::max(1, largest_side / std::max(width, height));
  corner_ = low + Eigen::Vector2d(0.0, height * resolution_);
  cv::resize(cells, picture_, {width * scale_, height * scale_}, 0, 0, cv::INTER_NEAREST);
}

cv::Point MapCanvas::At(const Eigen::Vector2d& point) const {
  const double x = (point.x() - corner_.x()) / resolution_ * scale_;
  const double y = (corner_.y() - point.y()) / resolution_ * scale_;
  return {static_cast<int>(std::lround(x * kSubpixel)),
          static_cast<int>(std::lround(y * kSubpixel))};
}

int MapCanvas::PixelsPerMetre() const {
  return static_cast<int>(std::lround(scale_ / resolution_));
}

void MapCanvas::FillCell(int column, int row, const cv::Scalar& colour) {
  const int x = (left_ + column) * scale_;
  const int y = picture_.rows - (below_ + row + 1) * scale_;
  picture_(cv::Rect(x, y, scale_, scale_)).setTo(colour);
}

void MapCanvas::DrawLine(const std::vector<Eigen::Vector2d>& points, const cv::Scalar& colour,
                         int thickness) {
  std::vector<cv::Point> pixels;
  pixels.reserve(points.size());
  for (const Eigen::Vector2d& point : points) pixels.push_back(At(point));
  cv::polylines(picture_, pixels, false, colour, thickness, cv::LINE_AA, kSubpixelBits);
}

void MapCanvas::DrawDot(const Eigen::Vector2d& point, const cv::Scalar& colour, int radius) {
  cv::circle(picture_, At(point), radius * kSubpixel, colour, -1, cv::LINE_AA, kSubpixelBits);
}

/// What is written over it can be read.
void MapCanvas::Fade(const cv::Rect& place) {
  cv::Mat part = picture_(place & cv::Rect({0, 0}, picture_.size()));
  part = 0.15 * part + cv::Scalar::all(0.85 * 255);
}

void MapCanvas::DrawScaleBar() {
  const double wanted = 0.2 * picture_.cols / PixelsPerMetre();
  const double power = std::pow(10.0, std::floor(std::log10(std::max(wanted, 0.1))));
  const double metres =
      wanted / power >= 5.0 ? 5.0 * power : (wanted / power >= 2.0 ? 2.0 * power : power);
  const int length = static_cast<int>(std::lround(metres * PixelsPerMetre()));
  const cv::Point left(20, picture_.rows - 20);
  Fade({left - cv::Point(10, 34), left + cv::Point(length + 10, 10)});
  cv::line(picture_, left, left + cv::Point(length, 0), kInk, 4);
  const cv::String text = cv::format(metres < 1.0 ? "%.1f m" : "%.0f m", metres);
  cv::putText(picture_, text, left + cv::Point(0, -10), kFont, 0.6, kInk, 1, cv::LINE_AA);
}

void MapCanvas::DrawLegend(const std::vector<LegendEntry>& entries) {
  if (entries.empty()) return;
  int width = 0;
  for (const LegendEntry& entry : entries) {
    width = std::max(width, cv::getTextSize(entry.name, kFont, 0.6, 1, nullptr).width);
  }
  Fade({10, 4, width + 64, 24 * static_cast<int>(entries.size()) + 8});
  int row = 24;
  for (const LegendEntry& entry : entries) {
    cv::line(picture_, {20, row - 5}, {56, row - 5}, entry.colour, 3, cv::LINE_AA);
    cv::putText(picture_, entry.name, {64, row}, kFont, 0.6, kInk, 1, cv::LINE_AA);
    row += 24;
  }
}

}  // namespace scan_image_slam
