#include "scan_image_slam/core/fusion/edge_extraction.h"

#include "scan_image_slam/core/fusion/edge_filter.h"
#include "scan_image_slam/core/fusion/step_fit.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

namespace scan_image_slam {
namespace {

/// A chain as part of an edge: how much of it is vertical, and where.
struct Run {
  double column = 0.0;
  double strength = 0.0;
  int sign = 0;
  int top = 0;
  int bottom = 0;
};

/// The runs in (nearly) one column, the strongest first.
using BrokenLine = std::vector<Run>;

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
  run.strength = BearingImage::kRowPixels * chain.Strength();
  const auto [top, bottom] =
      std::minmax_element(chain.pixels.begin(), chain.pixels.end(),
                          [](const cv::Point& a, const cv::Point& b) { return a.y < b.y; });
  run.top = top->y;
  run.bottom = bottom->y;
  for (const cv::Point& p : chain.pixels) run.column += SubpixelColumn(pixels, p);
  run.column /= static_cast<double>(chain.pixels.size());
  return run;
}

/// Joins the runs of one sign that lie in (nearly) the same column: a broken line is one edge.
std::vector<BrokenLine> JoinRuns(std::vector<Run> runs, double tolerance) {
  std::sort(runs.begin(), runs.end(), [](const Run& a, const Run& b) {
    return a.strength != b.strength ? a.strength > b.strength : a.column < b.column;
  });
  std::vector<BrokenLine> lines;
  for (const Run& run : runs) {
    const auto same = std::find_if(lines.begin(), lines.end(), [&](const BrokenLine& line) {
      return line.front().sign == run.sign &&
             std::abs(line.front().column - run.column) < tolerance;
    });
    if (same == lines.end()) {
      lines.push_back({run});
    } else {
      same->push_back(run);
    }
  }
  return lines;
}

bool ShareRows(const BrokenLine& a, const BrokenLine& b) {
  const auto overlap = [](const Run& r, const Run& s) {
    return r.top <= s.bottom && s.top <= r.bottom;
  };
  return std::any_of(a.begin(), a.end(), [&](const Run& r) {
    return std::any_of(b.begin(), b.end(), [&](const Run& s) { return overlap(r, s); });
  });
}

/// What lies beside a line: lines that blur into it are to be fitted with it, and before those
/// farther away its profile ends.
struct Surroundings {
  std::vector<double> columns;  ///< of the line and of those to be fitted with it
  double left = 0.0;            ///< first and last column of the profile
  double right = 0.0;
};

Surroundings SurroundingsOf(const BrokenLine& line, const std::vector<BrokenLine>& lines) {
  constexpr double kReach = 6.0;  // [px]
  constexpr double kNear = 4.0;   // [px]
  constexpr double kBlur = 2.0;   // as far as a step is smeared [px]
  const double at = line.front().column;
  Surroundings around{{at}, at - kReach, at + kReach};
  for (const BrokenLine& other : lines) {
    const double column = other.front().column;
    const double distance = std::abs(column - at);
    if (&other == &line || distance > kReach + kBlur || !ShareRows(line, other)) continue;
    if (distance < kNear) {
      around.columns.push_back(column);
    } else if (column < at) {
      around.left = std::max(around.left, column + kBlur);
    } else {
      around.right = std::min(around.right, column - kBlur);
    }
  }
  std::sort(around.columns.begin(), around.columns.end(),
            [&](double a, double b) { return std::abs(a - at) < std::abs(b - at); });
  if (around.columns.size() > kMostSteps) around.columns.resize(kMostSteps);
  return around;
}

/// Mean grey levels around a line in its rows, in the columns of its surroundings that the camera
/// sees.
GreyProfile ProfileOf(const BrokenLine& line, const Surroundings& around, const cv::Mat& grey,
                      const cv::Mat& seen) {
  const int middle = static_cast<int>(std::lround(line.front().column));
  const auto is_seen = [&](int x) {
    return x >= 0 && x < grey.cols && std::all_of(line.begin(), line.end(), [&](const Run& run) {
             return seen.at<std::uint8_t>(run.top, x) != 0 &&
                    seen.at<std::uint8_t>(run.bottom, x) != 0;
           });
  };
  int begin = middle;
  int end = middle + 1;
  while (begin - 1 >= around.left && is_seen(begin - 1)) --begin;
  while (end <= around.right && is_seen(end)) ++end;
  GreyProfile profile;
  profile.first_column = begin;
  profile.levels.assign(end - begin, 0.0);
  std::vector<double> squares(end - begin, 0.0);
  double rows = 0.0;
  for (const Run& run : line) {
    for (int y = run.top; y <= run.bottom; ++y) {
      const auto* row = grey.ptr<std::uint8_t>(y);
      rows += 1.0;
      for (int x = begin; x < end; ++x) {
        profile.levels[x - begin] += row[x];
        squares[x - begin] += row[x] * row[x];
      }
    }
  }
  double variance = 0.0;  // of the rows, mean over the columns
  for (std::size_t i = 0; i < squares.size(); ++i) {
    profile.levels[i] /= rows;
    variance += std::max(0.0, squares[i] / rows - profile.levels[i] * profile.levels[i]) /
                static_cast<double>(squares.size());
  }
  constexpr double kRounding = 0.3;  // [grey levels]
  profile.stddev = std::hypot(kRounding, std::sqrt(variance / std::max(1.0, rows - 1.0)));
  return profile;
}

ImageEdge ToEdge(const BrokenLine& line, const StepFit& step) {
  ImageEdge edge;
  edge.column = step.column;
  edge.column_stddev = step.stddev;
  edge.sign = line.front().sign;
  edge.contrast = std::abs(step.height);
  edge.top = line.front().top;
  edge.bottom = line.front().bottom;
  for (const Run& run : line) {
    edge.strength += run.strength;
    edge.top = std::min(edge.top, run.top);
    edge.bottom = std::max(edge.bottom, run.bottom);
  }
  return edge;
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
  const cv::Mat seen = image.mask().rowRange(region.begin, region.end);
  EdgePixels pixels = FindEdgePixels(levelled, options.edge_threshold);
  MaskOutside(region, seen, &pixels.sign);

  std::vector<Run> runs;
  for (const EdgeChain& chain : FollowChains(pixels, options.edge_threshold)) {
    if (chain.Strength() > 0.0) runs.push_back(Summarise(chain, pixels));
  }
  const std::vector<BrokenLine> lines = JoinRuns(std::move(runs), options.column_tolerance);
  std::vector<ImageEdge> edges;
  for (const BrokenLine& line : lines) {
    double rows = 0.0;
    for (const Run& run : line) rows += 0.5 * run.strength;
    if (rows < options.min_edge_rows) continue;
    const Surroundings around = SurroundingsOf(line, lines);
    const std::optional<StepFit> step =
        FitFirstStep(ProfileOf(line, around, levelled, seen), around.columns);
    if (!step || step->height * line.front().sign <= 0.0) continue;
    const int column = static_cast<int>(std::lround(step->column));
    const double distance = profile.columns[column].distance;
    if (distance <= 0.0) continue;  // beside the surface it was seen on
    if (rows * image.step() * distance < options.min_edge_length) continue;
    ImageEdge edge = ToEdge(line, *step);
    const int region_rows = region.bottom[column] - region.top[column] + 1;
    edge.weight = std::min(1.0, rows / (BearingImage::kRowPixels * region_rows));
    edge.top += region.begin;
    edge.bottom += region.begin;
    edges.push_back(edge);
  }
  std::sort(edges.begin(), edges.end(),
            [](const ImageEdge& a, const ImageEdge& b) { return a.column < b.column; });
  return edges;
}

}  // namespace scan_image_slam
