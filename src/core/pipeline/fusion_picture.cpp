#include "scan_image_slam/core/pipeline/fusion_picture.h"

#include "scan_image_slam/core/recording/number_text.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/imgproc.hpp>

namespace scan_image_slam {
namespace {

const cv::Scalar kDarkToLight(0, 140, 255);
const cv::Scalar kLightToDark(255, 200, 0);
const cv::Scalar kLeftOut(220, 70, 160);
const cv::Scalar kRefused(0, 0, 255);
constexpr int kHistogramHeight = 96;     // [px]
constexpr int kTextHeight = 34;          // of it [px]
constexpr double kMagnification = 20.0;  // of residuals [-]

const cv::Scalar& ColourOf(int sign) { return sign > 0 ? kDarkToLight : kLightToDark; }

/// Red near, blue far.
cv::Scalar RangeColour(double range) {
  constexpr double kFar = 10.0;  // [m]
  const double share = std::clamp(range / kFar, 0.0, 1.0);
  cv::Mat hsv(1, 1, CV_8UC3, cv::Scalar(120.0 * share, 255, 255));
  cv::cvtColor(hsv, hsv, cv::COLOR_HSV2BGR);
  const cv::Vec3b c = hsv.at<cv::Vec3b>(0, 0);
  return {static_cast<double>(c[0]), static_cast<double>(c[1]), static_cast<double>(c[2])};
}

void DrawRegion(const FusionEvidence& evidence, const BearingImage& image, cv::Mat* picture) {
  for (const auto& limits : {evidence.region.top, evidence.region.bottom}) {
    for (int c = 0; c < image.columns(); ++c) {
      if (evidence.region.bottom[c] < evidence.region.top[c]) continue;
      const cv::Point2f p = image.CameraPixel(c, std::clamp(limits[c], 0, image.rows() - 1));
      if (p.x >= 0.0f) cv::circle(*picture, p, 0, cv::Scalar(0, 220, 220), -1);
    }
  }
}

/// An edge as it is drawn: what the image shows, and what the matching made of it, if it is known.
struct DrawnEdge {
  ImageEdge edge;
  std::optional<EdgeMatch> match;

  bool Is(EdgeUse use) const { return match && match->use == use; }
  cv::Scalar Colour() const {
    if (Is(EdgeUse::kLeftOut)) return kLeftOut;
    return Is(EdgeUse::kRefused) ? kRefused : ColourOf(edge.sign);
  }
  int Width() const {
    const bool thin = Is(EdgeUse::kLeftOut) || Is(EdgeUse::kNew);
    return thin ? 1 : 1 + static_cast<int>(std::lround(2.0 * edge.weight));
  }
};

/// An edge on no clear surface never came to the matching, which is as good as left out there.
std::vector<DrawnEdge> EdgesToDraw(const FusionEvidence& evidence, const FusedModel& model,
                                   const MatchedMotion* match) {
  const bool matched = match != nullptr && match->edges.size() == model.edges.size();
  std::vector<DrawnEdge> edges;
  for (std::size_t i = 0; i < evidence.edges.size(); ++i) {
    DrawnEdge drawn{evidence.edges[i], std::nullopt};
    if (matched) {
      const int id = evidence.in_model[i];
      drawn.match = id < 0 ? EdgeMatch() : match->edges[id];
    }
    edges.push_back(drawn);
  }
  return edges;
}

/// Part of a column of the bearing image, or of a row of it, in the camera's picture.
void DrawLine(const BearingImage& image, double from_column, double to_column, int from_row,
              int to_row, const cv::Scalar& colour, int width, cv::Mat* picture) {
  const int steps =
      std::max(to_row - from_row, static_cast<int>(std::abs(to_column - from_column)));
  std::vector<cv::Point> line;
  for (int i = 0; i <= steps; ++i) {
    const double share = steps == 0 ? 0.0 : static_cast<double>(i) / steps;
    const int column =
        static_cast<int>(std::lround(from_column + share * (to_column - from_column)));
    const int row = static_cast<int>(std::lround(from_row + share * (to_row - from_row)));
    const cv::Point2f p = image.CameraPixel(std::clamp(column, 0, image.columns() - 1),
                                            std::clamp(row, 0, image.rows() - 1));
    if (p.x >= 0.0f) line.emplace_back(p);
  }
  // Smoothed, a thin line would fade.
  cv::polylines(*picture, line, false, colour, width, width > 1 ? cv::LINE_AA : cv::LINE_8);
}

void DrawEdge(const DrawnEdge& drawn, const BearingImage& image, cv::Mat* picture) {
  const ImageEdge& edge = drawn.edge;
  DrawLine(image, edge.column, edge.column, edge.top, edge.bottom, drawn.Colour(), drawn.Width(),
           picture);
  if (!drawn.Is(EdgeUse::kMatched)) return;
  const double expected = edge.column + kMagnification * drawn.match->residual / image.step();
  DrawLine(image, edge.column, expected, edge.top, edge.top, cv::Scalar::all(255), 2, picture);
}

std::string Describe(const std::vector<DrawnEdge>& edges, const BearingImage& image,
                     const MatchedMotion& match) {
  const auto count = [&](EdgeUse use) {
    return std::to_string(std::count_if(edges.begin(), edges.end(),
                                        [&](const DrawnEdge& edge) { return edge.Is(use); }));
  };
  double sum = 0.0;
  for (const DrawnEdge& edge : edges) {
    if (edge.Is(EdgeUse::kMatched)) sum += std::pow(edge.match->residual / image.step(), 2);
  }
  const double matched = std::max(1, CountMatched(match.edges));
  return "walls " + NumberText(1e3 * match.rms, 1) + " mm, edges " + count(EdgeUse::kMatched) +
         " matched (" + NumberText(std::sqrt(sum / matched), 2) + " px), " + count(EdgeUse::kNew) +
         " new, " + count(EdgeUse::kLeftOut) + " left out, " + count(EdgeUse::kRefused) +
         " refused";
}

/// Bars over the bearings that the picture shows, strong edges up to the text.
cv::Mat DrawHistogram(const std::vector<DrawnEdge>& edges, const BearingImage& image, int width,
                      const std::string& description) {
  cv::Mat strip(kHistogramHeight, width, CV_8UC3, cv::Scalar::all(30));
  for (const DrawnEdge& drawn : edges) {
    const ImageEdge& edge = drawn.edge;
    const int x = static_cast<int>(edge.column * (width - 1) / std::max(1, image.columns() - 1));
    const int height =
        static_cast<int>(std::lround(edge.weight * (kHistogramHeight - kTextHeight)));
    cv::line(strip, {x, kHistogramHeight - 1}, {x, kHistogramHeight - 1 - height}, drawn.Colour(),
             2);
  }
  const auto write = [&](const std::string& text, int bottom) {
    cv::putText(strip, text, {6, bottom}, cv::FONT_HERSHEY_SIMPLEX, 0.4, cv::Scalar::all(200), 1,
                cv::LINE_AA);
  };
  write(description, 14);
  write("vertical strength by bearing", 29);
  return strip;
}

}  // namespace

cv::Mat DrawFusion(const ScanImageFusion& fusion, const FusedModel& model,
                   const MatchedMotion* match) {
  const FusionEvidence& evidence = fusion.evidence();
  const BearingImage* image = fusion.bearing_image();
  if (image == nullptr || evidence.image.grey.empty()) return {};
  cv::Mat picture;
  cv::cvtColor(evidence.image.grey, picture, cv::COLOR_GRAY2BGR);
  DrawRegion(evidence, *image, &picture);
  const std::vector<cv::Point2f> beams = fusion.BeamPixels(model);
  for (std::size_t i = 0; i < beams.size(); ++i) {
    if (beams[i].x < 0.0f) continue;
    cv::circle(picture, beams[i], 2, RangeColour(model.beams[i].range), -1, cv::LINE_AA);
  }
  const std::vector<DrawnEdge> edges = EdgesToDraw(evidence, model, match);
  for (const DrawnEdge& edge : edges) DrawEdge(edge, *image, &picture);
  const std::string description =
      match != nullptr ? Describe(edges, *image, *match) : "not matched yet";
  cv::Mat whole;
  cv::vconcat(picture, DrawHistogram(edges, *image, picture.cols, description), whole);
  return whole;
}

}  // namespace scan_image_slam
