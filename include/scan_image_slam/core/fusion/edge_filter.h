#pragma once

#include <array>
#include <vector>

#include <opencv2/core.hpp>

namespace scan_image_slam {

/// The eight directions from a pixel to its neighbours: bin k is k * 45 degrees, counter-clockwise
/// from the right, so bin 2 is up (90) and bin 6 is down (270).
struct DirectionHistogram {
  std::array<double, 8> bins{};

  double Total() const;
  /// Entries at 90 and 270 degrees.
  double Vertical() const { return bins[2] + bins[6]; }
};

/// h_i of the paper: which of the eight neighbours of a pixel are edge pixels like itself.
DirectionHistogram NeighbourHistogram(const cv::Mat& edge_pixels, int x, int y);

/// w_i of the paper: the share of the vertical entries, 0 if there are no entries.
double VerticalWeight(const DirectionHistogram& h);

/// A run of edge pixels that the filter followed.
struct EdgeChain {
  DirectionHistogram accumulated;  ///< H of eq. 1
  int sign = 0;                    ///< +1: darker on the left; -1: darker on the right
  std::vector<cv::Point> pixels;   ///< in the order in which they were visited

  /// What eq. 1 leaves of the vertical directions: 2 (n - 1) for a vertical line of n pixels, 0 for
  /// a horizontal or a diagonal one.
  double Strength() const { return accumulated.Vertical(); }
};

/// Thin vertical edges of an image with the gradient that made them.
struct EdgePixels {
  cv::Mat sign;  ///< CV_8S: +1 or -1 on an edge pixel (see EdgeChain::sign), 0 elsewhere
  cv::Mat
      gradient;  ///< CV_16S: difference of the pixels on the right and on the left [grey levels]
};

/// Edge pixels: where the gradient is greater than in the same row beside it, and what makes up
/// half of a step of `threshold` [grey levels].
EdgePixels FindEdgePixels(const cv::Mat& grey, double threshold);

/// The filter of section 2.1: starts at every edge pixel not visited yet, steps on to the neighbour
/// of the same sign in the direction that holds most, until none follows, and accumulates
/// H = sum w_i h_i on the way (eq. 1). A chain counts if a step of `threshold` [grey levels] is
/// somewhere on it: a faint part of a strong edge belongs to it.
std::vector<EdgeChain> FollowChains(const EdgePixels& edges, double threshold);

/// Column of the edge at a pixel, below the pixel: the vertex of the parabola through the gradients
/// of the pixel and its two neighbours in the row.
double SubpixelColumn(const EdgePixels& edges, const cv::Point& pixel);

}  // namespace scan_image_slam
