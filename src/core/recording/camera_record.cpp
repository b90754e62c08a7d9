#include "scan_image_slam/core/recording/camera_record.h"

#include "scan_image_slam/core/geometry/pose2.h"
#include "scan_image_slam/core/recording/number_text.h"

#include <algorithm>
#include <cmath>

namespace scan_image_slam {
namespace {

constexpr double kDark = 30.0;     // [grey levels]
constexpr double kBright = 225.0;  // [grey levels]
const char kCalibrate[] = "calibrate the camera (camera_calibration), at the size of its images";

std::string SizeText(int width, int height) {
  return std::to_string(width) + "x" + std::to_string(height) + " px";
}

/// Seen between the left and the right border, lens distortion left aside [deg].
double Width(const CameraIntrinsics& camera) {
  const double fx = camera.k(0, 0);
  const double cx = camera.k(0, 2);
  return Degrees(std::atan2(cx, fx) + std::atan2(camera.width - cx, fx));
}

/// A centre or a focal length that no usual lens has.
std::string Implausible(const CameraIntrinsics& camera) {
  const auto centred = [](double centre, int size) {
    return centre > 0.25 * size && centre < 0.75 * size;
  };
  if (!centred(camera.k(0, 2), camera.width) || !centred(camera.k(1, 2), camera.height)) {
    return "the optical axis is far from the middle of the image";
  }
  if (Width(camera) < 10.0 || Width(camera) > 170.0) {
    return "the camera would see " + NumberText(Width(camera), 0) + " deg from left to right";
  }
  const double ratio = camera.k(0, 0) / camera.k(1, 1);
  if (ratio < 0.8 || ratio > 1.25) return "the pixels would not be square (K[0] and K[4])";
  return "";
}

}  // namespace

void ImageRecord::Add(int width, int height, const std::string& encoding, double brightness) {
  if (readable_++ == 0) encoding_ = encoding;
  ++sizes_[{width, height}];
  brightness_ += brightness;
}

void ImageRecord::AddUnreadable(const std::string& reason) {
  if (unreadable_++ == 0) reason_ = reason;
}

std::pair<int, int> ImageRecord::Size() const {
  if (sizes_.empty()) return {0, 0};
  return std::max_element(sizes_.begin(), sizes_.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

std::string DescribeImages(const ImageRecord& record) {
  if (record.readable() == 0) return "unreadable";
  const auto [width, height] = record.Size();
  return SizeText(width, height) + ", " + record.encoding() + ", mean grey level " +
         NumberText(record.Brightness(), 0);
}

std::string DescribeCalibration(const CameraIntrinsics& camera) {
  return SizeText(camera.width, camera.height) + ", " + NumberText(Width(camera), 0) +
         " deg wide, " + camera.distortion_model;
}

Findings CheckImages(const std::string& topic, const ImageRecord& record) {
  Findings findings;
  if (record.unreadable() > 0) {
    findings.push_back({record.readable() == 0 ? Severity::kError : Severity::kWarning,
                        topic + ": of the images looked at, " +
                            std::to_string(record.unreadable()) + " of " +
                            std::to_string(record.unreadable() + record.readable()) +
                            " can't be read: " + record.reason(),
                        "record mono8, bgr8, rgb8, a Bayer encoding, JPEG or PNG"});
  }
  if (record.readable() == 0) return findings;
  if (record.SizeChanges()) {
    findings.push_back({Severity::kWarning, topic + ": images of more than one size",
                        "only those of the size in camera_info are used"});
  }
  if (record.Brightness() < kDark || record.Brightness() > kBright) {
    findings.push_back({Severity::kWarning,
                        topic + ": the images are very " +
                            (record.Brightness() < kDark ? "dark" : "bright") +
                            ", mean grey level " + NumberText(record.Brightness(), 0) + " of 255",
                        "another, fixed exposure; in the dark a lower "
                        "scan_image_fusion/edge_threshold"});
  }
  if (record.bayer()) {
    findings.push_back(
        {Severity::kNote,
         topic + ": labelled " + record.encoding() + ", but it is the mosaic of a colour camera",
         "nothing: the mosaic is smoothed out; the right label would be a bayer_ one"});
  }
  return findings;
}

Findings CheckCalibration(const std::string& topic, const Calibration& calibration,
                          const ImageRecord& images) {
  if (!calibration.intrinsics) {
    return {{Severity::kError, topic + ": " + calibration.problem + "; the images can't be used",
             kCalibrate}};
  }
  const CameraIntrinsics& camera = *calibration.intrinsics;
  const auto [width, height] = images.Size();
  if (images.readable() > 0 && (width != camera.width || height != camera.height)) {
    return {{Severity::kError,
             topic + ": is for images of " + SizeText(camera.width, camera.height) +
                 ", but they have " + SizeText(width, height) + "; they can't be used",
             kCalibrate}};
  }
  Findings findings;
  const std::string implausible = Implausible(camera);
  if (!implausible.empty()) {
    findings.push_back({Severity::kWarning, topic + ": " + implausible, kCalibrate});
  }
  const bool straight =
      std::all_of(camera.d.begin(), camera.d.end(), [](double d) { return d == 0.0; });
  if (straight) {
    findings.push_back({Severity::kNote, topic + ": no lens distortion (D is zero or empty)",
                        "right for rectified images and simulators; otherwise calibrate"});
  }
  return findings;
}

}  // namespace scan_image_slam
