#include "scan_image_slam/core/fusion/edge_filter.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace scan_image_slam {
namespace {

/// Step to the neighbour in the direction of each bin; rows count downwards.
constexpr std::array<int, 8> kStepX = {1, 1, 0, -1, -1, -1, 0, 1};
constexpr std::array<int, 8> kStepY = {0, -1, -1, -1, 0, 1, 1, 1};

/// Of directions that hold the same, the vertical ones come first, then the diagonals.
constexpr std::array<int, 8> kPreference = {6, 2, 5, 7, 1, 3, 4, 0};

/// What is left of a step in the difference of the pixels beside it, by lens and resampling.
constexpr double kStepGain = 0.8;

bool IsEdge(const cv::Mat& edge_pixels, int x, int y, std::int8_t sign) {
  return x >= 0 && y >= 0 && x < edge_pixels.cols && y < edge_pixels.rows &&
         edge_pixels.at<std::int8_t>(y, x) == sign;
}

/// The direction to step on: towards the neighbour not visited yet whose bin holds most; -1: none.
int NextDirection(const DirectionHistogram& h, const DirectionHistogram& accumulated,
                  const cv::Mat& visited, const cv::Point& at) {
  int best = -1;
  for (const int k : kPreference) {
    if (h.bins[k] == 0.0) continue;
    if (visited.at<std::uint8_t>(at.y + kStepY[k], at.x + kStepX[k]) != 0) continue;
    if (best < 0 || accumulated.bins[k] > accumulated.bins[best]) best = k;
  }
  return best;
}

EdgeChain FollowChain(const cv::Mat& sign, const cv::Point& start, cv::Mat* visited) {
  EdgeChain chain;
  chain.sign = sign.at<std::int8_t>(start);
  cv::Point at = start;
  while (true) {
    visited->at<std::uint8_t>(at) = 1;
    chain.pixels.push_back(at);
    const DirectionHistogram h = NeighbourHistogram(sign, at.x, at.y);
    const double w = VerticalWeight(h);
    for (std::size_t k = 0; k < h.bins.size(); ++k) chain.accumulated.bins[k] += w * h.bins[k];
    const int direction = NextDirection(h, chain.accumulated, *visited, at);
    if (direction < 0) return chain;
    at += cv::Point(kStepX[direction], kStepY[direction]);
  }
}

}  // namespace

double DirectionHistogram::Total() const { return std::accumulate(bins.begin(), bins.end(), 0.0); }

DirectionHistogram NeighbourHistogram(const cv::Mat& edge_pixels, int x, int y) {
  DirectionHistogram h;
  const std::int8_t sign = edge_pixels.at<std::int8_t>(y, x);
  for (std::size_t k = 0; k < h.bins.size(); ++k) {
    if (IsEdge(edge_pixels, x + kStepX[k], y + kStepY[k], sign)) h.bins[k] = 1.0;
  }
  return h;
}

double VerticalWeight(const DirectionHistogram& h) {
  const double total = h.Total();
  return total > 0.0 ? h.Vertical() / total : 0.0;
}

EdgePixels FindEdgePixels(const cv::Mat& grey, double threshold) {
  const auto least = static_cast<std::int16_t>(std::ceil(0.5 * kStepGain * threshold));
  EdgePixels edges;
  edges.gradient = cv::Mat::zeros(grey.size(), CV_16S);
  edges.sign = cv::Mat::zeros(grey.size(), CV_8S);
  for (int y = 0; y < grey.rows; ++y) {
    const auto* level = grey.ptr<std::uint8_t>(y);
    auto* gradient = edges.gradient.ptr<std::int16_t>(y);
    auto* sign = edges.sign.ptr<std::int8_t>(y);
    for (int x = 1; x + 1 < grey.cols; ++x) {
      gradient[x] = static_cast<std::int16_t>(level[x + 1] - level[x - 1]);
    }
    for (int x = 1; x + 1 < grey.cols; ++x) {  // without branches: many pixels at once
      const auto here = static_cast<std::int16_t>(std::abs(gradient[x]));
      const bool is_edge = (here >= least) & (here > std::abs(gradient[x - 1])) &
                           (here >= std::abs(gradient[x + 1]));
      const auto side = static_cast<std::int8_t>(gradient[x] < 0 ? -1 : 1);
      sign[x] = static_cast<std::int8_t>(is_edge ? side : 0);
    }
  }
  return edges;
}

std::vector<EdgeChain> FollowChains(const EdgePixels& edges, double threshold) {
  const cv::Mat& sign = edges.sign;
  std::vector<EdgeChain> chains;
  cv::Mat visited = cv::Mat::zeros(sign.size(), CV_8U);
  const auto is_step = [&](const cv::Point& p) {
    return std::abs(edges.gradient.at<std::int16_t>(p)) >= kStepGain * threshold;
  };
  for (int y = 0; y < sign.rows; ++y) {
    const auto* sign_row = sign.ptr<std::int8_t>(y);
    for (int x = 0; x < sign.cols; ++x) {
      if (sign_row[x] == 0 || visited.at<std::uint8_t>(y, x) != 0) continue;
      EdgeChain chain = FollowChain(sign, cv::Point(x, y), &visited);
      if (std::any_of(chain.pixels.begin(), chain.pixels.end(), is_step)) {
        chains.push_back(std::move(chain));
      }
    }
  }
  return chains;
}

double SubpixelColumn(const EdgePixels& edges, const cv::Point& pixel) {
  if (pixel.x < 1 || pixel.x + 1 >= edges.gradient.cols) return pixel.x;
  const auto* row = edges.gradient.ptr<std::int16_t>(pixel.y);
  const double left = std::abs(row[pixel.x - 1]);
  const double here = std::abs(row[pixel.x]);
  const double right = std::abs(row[pixel.x + 1]);
  const double curvature = left - 2.0 * here + right;
  if (curvature >= 0.0) return pixel.x;
  return pixel.x + std::clamp(0.5 * (left - right) / curvature, -0.5, 0.5);
}

}  // namespace scan_image_slam
