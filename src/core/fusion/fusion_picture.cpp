#include "scan_image_slam/core/fusion/fusion_picture.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace scan_image_slam {
namespace {

const cv::Scalar kDarkToLight(0, 140, 255);
const cv::Scalar kLightToDark(255, 200, 0);
constexpr int kHistogramHeight = 80;  // [px]

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

void DrawEdge(const ImageEdge& edge, const BearingImage& image, cv::Mat* picture) {
  const int column = std::clamp(static_cast<int>(std::lround(edge.column)), 0, image.columns() - 1);
  std::vector<cv::Point> line;
  for (int row = edge.top; row <= edge.bottom; ++row) {
    const cv::Point2f p = image.CameraPixel(column, row);
    if (p.x >= 0.0f) line.emplace_back(p);
  }
  const int width = 1 + static_cast<int>(std::lround(2.0 * edge.weight));
  cv::polylines(*picture, line, false, ColourOf(edge.sign), width, cv::LINE_AA);
}

/// Bars over the bearings that the picture shows, strong edges up to the top.
cv::Mat DrawHistogram(const FusionEvidence& evidence, const BearingImage& image, int width) {
  cv::Mat strip(kHistogramHeight, width, CV_8UC3, cv::Scalar::all(30));
  for (const ImageEdge& edge : evidence.edges) {
    const int x = static_cast<int>(edge.column * (width - 1) / std::max(1, image.columns() - 1));
    const int height = static_cast<int>(std::lround(edge.weight * (kHistogramHeight - 18)));
    cv::line(strip, {x, kHistogramHeight - 1}, {x, kHistogramHeight - 1 - height},
             ColourOf(edge.sign), 2);
  }
  cv::putText(strip, "vertical strength by bearing", {6, 14}, cv::FONT_HERSHEY_SIMPLEX, 0.4,
              cv::Scalar::all(200), 1, cv::LINE_AA);
  return strip;
}

}  // namespace

cv::Mat DrawFusion(const ScanImageFusion& fusion, const FusedModel& model) {
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
  for (const ImageEdge& edge : evidence.edges) DrawEdge(edge, *image, &picture);
  cv::Mat whole;
  cv::vconcat(picture, DrawHistogram(evidence, *image, picture.cols), whole);
  return whole;
}

}  // namespace scan_image_slam
