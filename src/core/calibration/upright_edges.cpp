#include "scan_image_slam/core/calibration/upright_edges.h"

#include "scan_image_slam/core/fusion/edge_filter.h"

#include <algorithm>
#include <cmath>

namespace scan_image_slam {
namespace {

constexpr double kMaxLean = 0.15;    // more is no vertical edge of a camera whose attitude is known
constexpr std::size_t kFewest = 3;   // pixels of an edge
constexpr double kMaxScatter = 0.8;  // of the pixels around the line [px]

/// Least squares of the columns over the rows.
UprightEdge FitLine(const std::vector<cv::Point2d>& pixels) {
  UprightEdge edge;
  const double n = static_cast<double>(pixels.size());
  for (const cv::Point2d& p : pixels) {
    edge.column += p.x / n;
    edge.row += p.y / n;
  }
  double yy = 0.0;
  double xy = 0.0;
  for (const cv::Point2d& p : pixels) {
    yy += (p.y - edge.row) * (p.y - edge.row);
    xy += (p.y - edge.row) * (p.x - edge.column);
  }
  edge.lean = yy > 0.0 ? xy / yy : 0.0;
  double squares = 0.0;
  for (const cv::Point2d& p : pixels) squares += std::pow(p.x - edge.ColumnAt(p.y), 2);
  constexpr double kPixelVariance = 0.04;  // floor, by what is left of the pixels' grid [px^2]
  edge.scatter = std::sqrt(squares / n);
  edge.lean_stddev = std::sqrt((kPixelVariance + squares / n) / std::max(yy, 1e-9));
  const auto rows = std::minmax_element(pixels.begin(), pixels.end(),
                                        [](const auto& a, const auto& b) { return a.y < b.y; });
  edge.top = static_cast<int>(rows.first->y);
  edge.bottom = static_cast<int>(rows.second->y);
  return edge;
}

double MedianColumn(std::vector<cv::Point2d> pixels) {
  const auto middle = pixels.begin() + static_cast<std::ptrdiff_t>(pixels.size() / 2);
  std::nth_element(pixels.begin(), middle, pixels.end(),
                   [](const auto& a, const auto& b) { return a.x < b.x; });
  return middle->x;
}

}  // namespace

UprightEdge FitUprightEdge(const std::vector<cv::Point2d>& pixels, double min_rows) {
  UprightEdge none;
  none.bottom = -1;
  if (pixels.size() < kFewest) return none;
  // Where a chain turns round a corner, its pixels leave the column that most of them are in.
  UprightEdge edge;
  edge.column = MedianColumn(pixels);
  const auto rows_of = std::minmax_element(pixels.begin(), pixels.end(),
                                           [](const auto& a, const auto& b) { return a.y < b.y; });
  double gate = 2.0 + 0.5 * kMaxLean * (rows_of.second->y - rows_of.first->y + 1.0);
  std::vector<cv::Point2d> kept;
  for (int round = 0; round < 3; ++round, gate = std::max(1.0, 0.4 * gate)) {
    kept.clear();
    for (const cv::Point2d& p : pixels) {
      if (std::abs(p.x - edge.ColumnAt(p.y)) <= gate) kept.push_back(p);
    }
    if (kept.size() < kFewest) return none;
    edge = FitLine(kept);
  }
  const double rows = edge.bottom - edge.top + 1.0;
  const bool upright = std::abs(edge.lean) <= kMaxLean && edge.scatter <= kMaxScatter;
  return rows >= min_rows && upright ? edge : none;
}

std::vector<UprightEdge> FindUprightEdges(const cv::Mat& grey, const BearingImage& image, int begin,
                                          int end, const EdgeExtractionOptions& options) {
  if (begin >= end) return {};
  EdgePixels pixels = FindEdgePixels(image.Resample(grey, begin, end), options.edge_threshold);
  pixels.sign.setTo(0, image.mask().rowRange(begin, end) == 0);
  // Lines are fitted in rows as fine as the columns.
  constexpr int kRow = BearingImage::kRowPixels;
  std::vector<UprightEdge> edges;
  for (const EdgeChain& chain : FollowChains(pixels, options.edge_threshold)) {
    if (chain.Strength() < 2.0 * (options.min_edge_rows / kRow - 1.0)) continue;
    std::vector<cv::Point2d> points;
    points.reserve(chain.pixels.size());
    for (const cv::Point& p : chain.pixels)
      points.emplace_back(SubpixelColumn(pixels, p), kRow * (p.y + begin));
    UprightEdge edge = FitUprightEdge(points, options.min_edge_rows);
    if (edge.bottom < edge.top) continue;
    edge.row /= kRow;
    edge.lean *= kRow;
    edge.lean_stddev *= kRow;
    edge.top /= kRow;
    edge.bottom /= kRow;
    edges.push_back(edge);
  }
  return edges;
}

}  // namespace scan_image_slam
