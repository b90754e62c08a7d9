#pragma once

#include "scan_image_slam/core/recording/finding.h"
#include "scan_image_slam/core/sensor/camera_model.h"

#include <map>
#include <optional>
#include <string>

namespace scan_image_slam {

/// What the images of one topic look like.
class ImageRecord {
 public:
  /// An image that was looked at: its size, how its pixels are coded, its mean [grey levels].
  void Add(int width, int height, const std::string& encoding, double brightness);
  void AddBayer() { bayer_ = true; }  ///< grey by its label, and a colour mosaic in truth
  void AddUnreadable(const std::string& reason);

  int readable() const { return readable_; }
  int unreadable() const { return unreadable_; }
  const std::string& reason() const { return reason_; }  ///< of the first that is unreadable
  bool bayer() const { return bayer_; }
  /// Width and height of most images [px].
  std::pair<int, int> Size() const;
  bool SizeChanges() const { return sizes_.size() > 1; }
  const std::string& encoding() const { return encoding_; }  ///< of the first image
  double Brightness() const { return readable_ == 0 ? 0.0 : brightness_ / readable_; }

 private:
  int readable_ = 0;
  int unreadable_ = 0;
  std::string reason_;
  bool bayer_ = false;
  std::map<std::pair<int, int>, int> sizes_;
  std::string encoding_;
  double brightness_ = 0.0;  ///< sum
};

/// What a camera_info says; either the intrinsics or why they can't be used.
struct Calibration {
  std::optional<CameraIntrinsics> intrinsics;
  std::string problem;
};

/// One line, e.g. `640x480 px, mono8, mean grey level 93`.
std::string DescribeImages(const ImageRecord& record);
/// One line, e.g. `640x480 px, 60 deg wide, plumb_bob`.
std::string DescribeCalibration(const CameraIntrinsics& intrinsics);

Findings CheckImages(const std::string& topic, const ImageRecord& record);

/// `images`: those that the calibration belongs to. An error means that they can't be used with it.
Findings CheckCalibration(const std::string& topic, const Calibration& calibration,
                          const ImageRecord& images);

}  // namespace scan_image_slam
