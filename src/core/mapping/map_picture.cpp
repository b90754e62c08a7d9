#include "scan_image_slam/core/mapping/map_picture.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace scan_image_slam {
namespace {

constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
const cv::Scalar kInk(40, 40, 40);

/// From metres in the map to pixels of the picture.
class Canvas {
 public:
  Canvas(const MapImage& map, int largest_side) : map_(map) {
    const int cells = std::max({map.width, map.height, 1});
    scale_ = std::max(1, largest_side / cells);
  }
  cv::Size size() const { return {map_.width * scale_, map_.height * scale_}; }
  cv::Point At(const Pose2& p) const {
    constexpr int kSubpixel = 16;
    const double x = (p.x - map_.origin_x) / map_.resolution * scale_;
    const double y = size().height - (p.y - map_.origin_y) / map_.resolution * scale_;
    return {static_cast<int>(std::lround(x * kSubpixel)),
            static_cast<int>(std::lround(y * kSubpixel))};
  }
  int PixelsPerMetre() const { return static_cast<int>(std::lround(scale_ / map_.resolution)); }

 private:
  const MapImage& map_;
  int scale_;
};

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

void DrawPath(const DrawnPath& path, const Canvas& canvas, cv::Mat* picture) {
  std::vector<cv::Point> points;
  for (const Pose2& pose : path.poses) points.push_back(canvas.At(pose));
  cv::polylines(*picture, points, false, path.colour, 2, cv::LINE_AA, 4);
  if (!points.empty()) cv::circle(*picture, points.back(), 6 * 16, path.colour, -1, cv::LINE_AA, 4);
}

/// A bar of one, two or five metres (or ten times as many) with its length.
void DrawScaleBar(const Canvas& canvas, cv::Mat* picture) {
  const double wanted = 0.2 * picture->cols / canvas.PixelsPerMetre();
  const double power = std::pow(10.0, std::floor(std::log10(std::max(wanted, 0.1))));
  const double metres =
      wanted / power >= 5.0 ? 5.0 * power : (wanted / power >= 2.0 ? 2.0 * power : power);
  const int length = static_cast<int>(std::lround(metres * canvas.PixelsPerMetre()));
  const cv::Point left(20, picture->rows - 20);
  cv::line(*picture, left, left + cv::Point(length, 0), kInk, 4);
  cv::String text = cv::format(metres < 1.0 ? "%.1f m" : "%.0f m", metres);
  cv::putText(*picture, text, left + cv::Point(0, -10), kFont, 0.6, kInk, 1, cv::LINE_AA);
}

void DrawLegend(const std::vector<DrawnPath>& paths, cv::Mat* picture) {
  int row = 24;
  for (const DrawnPath& path : paths) {
    cv::line(*picture, {20, row - 5}, {56, row - 5}, path.colour, 3, cv::LINE_AA);
    cv::putText(*picture, path.name, {64, row}, kFont, 0.6, kInk, 1, cv::LINE_AA);
    row += 24;
  }
}

}  // namespace

cv::Mat DrawMap(const MapImage& map, const std::vector<DrawnPath>& paths, int largest_side) {
  // Paths may leave the map, as the encoders' do: the picture grows to hold them.
  MapImage whole = map;
  double min_x = map.origin_x, min_y = map.origin_y;
  double max_x = min_x + map.width * map.resolution, max_y = min_y + map.height * map.resolution;
  for (const DrawnPath& path : paths) {
    for (const Pose2& p : path.poses) {
      min_x = std::min(min_x, p.x - map.resolution);
      min_y = std::min(min_y, p.y - map.resolution);
      max_x = std::max(max_x, p.x + map.resolution);
      max_y = std::max(max_y, p.y + map.resolution);
    }
  }
  const int left = static_cast<int>(std::ceil((map.origin_x - min_x) / map.resolution));
  const int below = static_cast<int>(std::ceil((map.origin_y - min_y) / map.resolution));
  whole.origin_x = map.origin_x - left * map.resolution;
  whole.origin_y = map.origin_y - below * map.resolution;
  whole.width = static_cast<int>(std::ceil((max_x - whole.origin_x) / map.resolution));
  whole.height = static_cast<int>(std::ceil((max_y - whole.origin_y) / map.resolution));
  cv::Mat cells(whole.height, whole.width, CV_8UC3, cv::Scalar::all(205));
  if (map.width > 0) {
    GreyCells(map).copyTo(
        cells(cv::Rect(left, whole.height - below - map.height, map.width, map.height)));
  }

  if (cells.empty()) return cells;

  const Canvas canvas(whole, largest_side);
  cv::Mat picture;
  cv::resize(cells, picture, canvas.size(), 0, 0, cv::INTER_NEAREST);
  for (const DrawnPath& path : paths) DrawPath(path, canvas, &picture);
  DrawScaleBar(canvas, &picture);
  DrawLegend(paths, &picture);
  return picture;
}

}  // namespace scan_image_slam
