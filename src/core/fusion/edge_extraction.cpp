#include "scan_image_slam/core/fusion/edge_extraction.h"

#include "scan_image_slam/core/fusion/edge_filter.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace scan_image_slam {
namespace {

/// A chain as part of an edge: how much of it is vertical, and where.
struct Run {
  double column = 0.0;
  double variance = 0.0;  ///< of the pixels' columns [px^2]
  double strength = 0.0;
  double contrast = 0.0;
  int sign = 0;
  int top = 0;
  int bottom = 0;
};

/// Edge pixels outside the region of interest, or next to what the camera does not see, do not
/// count.
void MaskOutside(const RegionOfInterest& region, const cv::Mat& seen, cv::Mat* sign) {
  for (int y = 0; y < sign->rows; ++y) {
    auto* row = sign->ptr<std::int8_t>(y);
    const auto* seen_row = seen.ptr<std::uint8_t>(y);
    const int image_row = region.begin + y;
    for (int x = 0; x < sign->cols; ++x) {
      if (seen_row[x] == 0 || image_row < region.top[x] || image_row > region.bottom[x]) row[x] = 0;
    }
  }
}

Run Summarise(const EdgeChain& chain, const EdgePixels& pixels) {
  Run run;
  run.sign = chain.sign;
  run.strength = chain.Strength();
  run.top = chain.pixels.front().y;
  run.bottom = run.top;
  double sum = 0.0;
  double squares = 0.0;
  for (const cv::Point& p : chain.pixels) {
    const double column = SubpixelColumn(pixels, p);
    sum += column;
    squares += column * column;
    run.contrast += std::abs(pixels.gradient.at<std::int16_t>(p)) / kStepGain;
    run.top = std::min(run.top, p.y);
    run.bottom = std::max(run.bottom, p.y);
  }
  const double n = static_cast<double>(chain.pixels.size());
  run.column = sum / n;
  run.variance = std::max(0.0, squares / n - run.column * run.column);
  run.contrast /= n;
  return run;
}

/// Joins the runs of one sign that lie in (nearly) the same column: a broken line is one edge.
std::vector<ImageEdge> JoinRuns(std::vector<Run> runs, const EdgeExtractionOptions& options) {
  std::sort(runs.begin(), runs.end(), [](const Run& a, const Run& b) {
    return a.strength != b.strength ? a.strength > b.strength : a.column < b.column;
  });
  constexpr double kPixelVariance = 0.04;  // floor of a column's variance [px^2]
  std::vector<ImageEdge> edges;
  std::vector<double> variances;
  for (const Run& run : runs) {
    const auto same = std::find_if(edges.begin(), edges.end(), [&](const ImageEdge& e) {
      return e.sign == run.sign && std::abs(e.column - run.column) < options.column_tolerance;
    });
    if (same == edges.end()) {
      ImageEdge edge;
      edge.column = run.column;
      edge.sign = run.sign;
      edge.strength = run.strength;
      edge.contrast = run.contrast;
      edge.top = run.top;
      edge.bottom = run.bottom;
      edge.column_stddev = std::sqrt(kPixelVariance + run.variance / 4.0);
      edges.push_back(edge);
      continue;
    }
    const double share = run.strength / (same->strength + run.strength);
    same->column += share * (run.column - same->column);
    same->contrast += share * (run.contrast - same->contrast);
    same->strength += run.strength;
    same->top = std::min(same->top, run.top);
    same->bottom = std::max(same->bottom, run.bottom);
  }
  return edges;
}

}  // namespace

void EdgeExtractionOptions::Validate() const {
  const auto require = [](bool ok, const char* what) {
    if (!ok) throw std::invalid_argument(what);
  };
  require(roi_below >= 0.0, "roi_below must not be negative");
  require(roi_above >= 0.0, "roi_above must not be negative");
  require(roi_below + roi_above > 0.0, "roi_below and roi_above must not both be zero");
  require(edge_threshold > 0.0, "edge_threshold must be positive");
  require(min_edge_length >= 0.0, "min_edge_length must not be negative");
  require(min_edge_rows >= 0.0, "min_edge_rows must not be negative");
  require(column_tolerance > 0.0, "column_tolerance must be positive");
}

RegionOfInterest MakeRegionOfInterest(const SurfaceProfile& profile, const BearingImage& image,
                                      double laser_height, const EdgeExtractionOptions& options) {
  RegionOfInterest region;
  region.top.assign(image.columns(), 0);
  region.bottom.assign(image.columns(), -1);
  region.begin = image.rows();
  region.end = 0;
  const double above = laser_height + options.roi_above - image.centre().z();
  const double below = laser_height - options.roi_below - image.centre().z();
  for (int c = 0; c < image.columns(); ++c) {
    const double distance = profile.columns[c].distance;
    if (distance <= 0.0) continue;
    const auto row_of = [&](double height, double first, double last) {
      return static_cast<int>(std::floor(std::clamp(image.Row(height / distance), first, last)));
    };
    region.top[c] = row_of(above, 0.0, image.rows());
    region.bottom[c] = row_of(below, -1.0, image.rows() - 1.0);
    if (region.bottom[c] < region.top[c]) continue;
    region.begin = std::min(region.begin, region.top[c]);
    region.end = std::max(region.end, region.bottom[c] + 1);
  }
  return region;
}

std::vector<ImageEdge> ExtractEdges(const cv::Mat& grey, const BearingImage& image,
                                    const SurfaceProfile& profile, const RegionOfInterest& region,
                                    const EdgeExtractionOptions& options) {
  if (region.begin >= region.end) return {};
  const cv::Mat levelled = image.Resample(grey, region.begin, region.end);
  EdgePixels pixels = FindEdgePixels(levelled, options.edge_threshold);
  MaskOutside(region, image.mask().rowRange(region.begin, region.end), &pixels.sign);

  std::vector<Run> runs;
  for (const EdgeChain& chain : FollowChains(pixels.sign)) {
    if (chain.Strength() > 0.0) runs.push_back(Summarise(chain, pixels));
  }
  std::vector<ImageEdge> edges;
  for (ImageEdge& edge : JoinRuns(std::move(runs), options)) {
    const int column =
        std::clamp(static_cast<int>(std::lround(edge.column)), 0, image.columns() - 1);
    const double rows = 0.5 * edge.strength;
    const double metres = rows * image.step() * profile.columns[column].distance;
    if (profile.columns[column].distance <= 0.0) continue;  // beside the surface it was seen on
    if (rows < options.min_edge_rows || metres < options.min_edge_length) continue;
    edge.weight = std::min(1.0, rows / (region.bottom[column] - region.top[column] + 1));
    edge.top += region.begin;
    edge.bottom += region.begin;
    edges.push_back(edge);
  }
  std::sort(edges.begin(), edges.end(),
            [](const ImageEdge& a, const ImageEdge& b) { return a.column < b.column; });
  return edges;
}

}  // namespace scan_image_slam
