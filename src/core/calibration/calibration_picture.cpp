#include "scan_image_slam/core/calibration/calibration_picture.h"

#include "scan_image_slam/core/calibration/calibrated_camera.h"
#include "scan_image_slam/core/calibration/upright_edges.h"
#include "scan_image_slam/core/evaluation/trajectory_lookup.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <opencv2/imgproc.hpp>

namespace scan_image_slam {
namespace {

constexpr double kBarHalfHeight = 0.25;  // of a discontinuity, above and below the plane [m]

/// Red near, blue far.
cv::Scalar RangeColour(double range) {
  constexpr double kFar = 8.0;  // [m]
  const double share = std::clamp(range / kFar, 0.0, 1.0);
  return {255.0 * share, 80.0, 255.0 * (1.0 - share)};
}

class PictureOfView {
 public:
  PictureOfView(const CalibrationRecorder& recorder, const ScanImageFusion& fusion,
                const CalibrationVector& correction)
      : snapshot_(recorder.snapshot()),
        trajectory_(recorder.data().trajectory),
        fusion_(fusion),
        camera_from_base_(Corrected(fusion.camera_from_base().inverse(), correction).inverse()) {
    cv::cvtColor(snapshot_.evidence.image.grey, picture_, cv::COLOR_GRAY2BGR);
    const Stamp stamp = snapshot_.evidence.image.stamp + FromSeconds(correction[kTime]);
    const auto at_image = PoseAt(trajectory_, stamp, {});
    const auto at_scan = PoseAt(trajectory_, snapshot_.model.stamp, {});
    if (at_image && at_scan) image_from_scan_ = at_image->Inverse() * *at_scan;
  }

  void DrawEdges() {
    const FusionEvidence& evidence = snapshot_.evidence;
    const BearingImage& image = *fusion_.bearing_image();
    for (const UprightEdge& edge :
         FindUprightEdges(evidence.image.grey, image, evidence.region.begin, evidence.region.end,
                          fusion_.options().edges)) {
      std::vector<cv::Point> line;
      for (int row = edge.top; row <= edge.bottom; ++row) {
        const int column = static_cast<int>(std::lround(edge.ColumnAt(row)));
        if (column < 0 || column >= image.columns()) continue;
        const cv::Point2f p = image.CameraPixel(column, row);
        if (p.x >= 0.0F) line.emplace_back(p);
      }
      cv::polylines(picture_, line, false, cv::Scalar(0, 160, 255), 1, cv::LINE_AA);
    }
  }

  void DrawBeams() {
    for (const ModelBeam& beam : snapshot_.model.beams) {
      if (!beam.hit()) continue;
      const cv::Point2f p = Pixel(beam.point, 0.0);
      if (p.x >= 0.0F) cv::circle(picture_, p, 1, RangeColour(beam.range), -1, cv::LINE_AA);
    }
  }

  void DrawJumps() {
    for (const RangeJump& jump : FindRangeJumps(snapshot_.model, {})) {
      const Eigen::Vector2d in_base =
          Move(snapshot_.model.sweep_velocity, jump.time_offset) *
          Eigen::Vector2d(snapshot_.model.base_from_laser.translation() +
                          jump.range *
                              Eigen::Vector2d(std::cos(jump.heading), std::sin(jump.heading)));
      const cv::Point2f low = Pixel(in_base, -kBarHalfHeight);
      const cv::Point2f high = Pixel(in_base, kBarHalfHeight);
      if (low.x < 0.0F || high.x < 0.0F) continue;
      cv::line(picture_, low, high, cv::Scalar::all(255), 1, cv::LINE_AA);
    }
  }

  cv::Mat Labelled(const std::string& label) {
    cv::putText(picture_, label, {8, 20}, cv::FONT_HERSHEY_SIMPLEX, 0.6, cv::Scalar(0, 255, 255), 1,
                cv::LINE_AA);
    return picture_;
  }

 private:
  /// Of a point in the base frame at the stamp of the scan, so far above the laser's plane.
  cv::Point2f Pixel(const Eigen::Vector2d& in_base, double above) const {
    const Eigen::Vector2d p = image_from_scan_ * in_base;
    const Eigen::Vector3d q =
        camera_from_base_ * Eigen::Vector3d(p.x(), p.y(), fusion_.laser().height + above);
    return fusion_.camera()->Project({cv::Point3d(q.x(), q.y(), q.z())}).front();
  }

  const CalibrationSnapshot& snapshot_;
  const Trajectory& trajectory_;
  const ScanImageFusion& fusion_;
  Eigen::Isometry3d camera_from_base_;
  Pose2 image_from_scan_;
  cv::Mat picture_;
};

}  // namespace

cv::Mat DrawCalibration(const CalibrationRecorder& recorder, const ScanImageFusion& fusion,
                        const CalibrationVector& correction) {
  if (recorder.snapshot().evidence.image.grey.empty()) return {};
  const auto draw = [&](const CalibrationVector& by, const std::string& label) {
    PictureOfView picture(recorder, fusion, by);
    picture.DrawEdges();
    picture.DrawBeams();
    picture.DrawJumps();
    return picture.Labelled(label);
  };
  cv::Mat both;
  cv::vconcat(draw({}, "before"), draw(correction, "after"), both);
  return both;
}

}  // namespace scan_image_slam
