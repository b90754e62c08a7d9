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

/// The longest round length below a fifth of the picture.
double MapCanvas::BarLength() const {
  const double wanted = std::max(0.2 * picture_.cols / scale_ * resolution_, 0.1);
  const double power = std::pow(10.0, std::floor(std::log10(wanted)));
  if (wanted / power >= 5.0) return 5.0 * power;
  return wanted / power >= 2.0 ? 2.0 * power : power;
}

cv::Mat MapCanvas::Captioned(const std::vector<LegendEntry>& legend) const {
  constexpr double kSize = 0.6;
  constexpr int kRow = 24;  // [px], as all here
  constexpr int kMargin = 20;
  constexpr int kSample = 36;  // of a line's colour
  const double metres = BarLength();
  const int bar = static_cast<int>(std::lround(metres / resolution_ * scale_));
  const std::string length = cv::format(metres < 1.0 ? "%.1f m" : "%.0f m", metres);
  const auto width_of = [](const std::string& text) {
    return cv::getTextSize(text, kFont, kSize, 1, nullptr).width;
  };
  const int bar_width = std::max(bar, width_of(length));
  const int column = kMargin + bar_width + 2 * kMargin;  // where the legend begins
  int width = kMargin + bar_width + kMargin;
  for (const LegendEntry& entry : legend) {
    width = std::max(width, column + kSample + 8 + width_of(entry.name) + kMargin);
  }
  const int rows = std::max(2, static_cast<int>(legend.size()));
  cv::Mat captioned;
  cv::copyMakeBorder(picture_, captioned, 0, rows * kRow + 12, 0,
                     std::max(0, width - picture_.cols), cv::BORDER_CONSTANT, cv::Scalar::all(255));
  const auto write = [&](const std::string& text, const cv::Point& at) {
    cv::putText(captioned, text, at, kFont, kSize, kInk, 1, cv::LINE_AA);
  };
  int row = picture_.rows + kRow;
  write(length, {kMargin, row});
  cv::line(captioned, {kMargin, row + 14}, {kMargin + bar, row + 14}, kInk, 4);
  for (const LegendEntry& entry : legend) {
    cv::line(captioned, {column, row - 5}, {column + kSample, row - 5}, entry.colour, 3);
    write(entry.name, {column + kSample + 8, row});
    row += kRow;
  }
  return captioned;
}

}  // namespace scan_image_slam
