#pragma once

#include "scan_image_slam/core/fusion/bearing_image.h"
#include "scan_image_slam/core/fusion/edge_extraction.h"
#include "scan_image_slam/core/fusion/fused_model.h"
#include "scan_image_slam/core/fusion/scan_model.h"
#include "scan_image_slam/core/fusion/surface_profile.h"
#include "scan_image_slam/core/sensor/camera_model.h"
#include "scan_image_slam/core/sensor/laser_scan.h"
#include "scan_image_slam/core/sensor/odometry_buffer.h"

#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

namespace scan_image_slam {

struct ScanImageFusionOptions {
  ScanModelOptions scan;
  EdgeExtractionOptions edges;
  OdometryOptions odometry;
  double max_image_age = 0.1;        ///< between the stamps of an image and of its scan [s]
  double camera_time_offset = 0.0;   ///< added to the stamps of the images [s]
  double max_edge_slant = 21.0;      ///< of an edge in use: wall per angle of the view [m/rad]
  double edge_bearing_stddev = 0.1;  ///< of an edge's column, beside that of its fit [px]
  /// Throws std::invalid_argument, naming the field, if a value is out of range.
  void Validate() const;
};

/// One picture of the camera.
struct CameraImage {
  Stamp stamp = 0;                    ///< middle of the exposure [ns]
  cv::Mat grey;                       ///< CV_8U, of the size in the intrinsics
  std::shared_ptr<const void> owner;  ///< keeps alive what `grey` is a view of, if it is one
};

/// What the fusion saw in the last image, for pictures and tools.
struct FusionEvidence {
  CameraImage image;
  SurfaceProfile profile;
  RegionOfInterest region;
  std::vector<ImageEdge> edges;  ///< in the bearing image
  std::vector<int> in_model;     ///< their places among the model's; -1: on no clear surface
};

/// The first stage of the system: fuses a scan with the image nearest to it (section 2.1 of the
/// paper).
class ScanImageFusion {
 public:
  explicit ScanImageFusion(const ScanImageFusionOptions& options);

  /// Encoder readings, in any rate; see OdometryBuffer.
  OdometryBuffer::Result AddOdometry(Stamp stamp, const Pose2& odom_from_base) {
    return odometry_.Add(stamp, odom_from_base);
  }
  const OdometryBuffer& odometry() const { return odometry_; }

  const ScanImageFusionOptions& options() const { return options_; }
  /// From the next scan on; the limits of the odometry stay. Throws std::invalid_argument, and
  /// changes nothing, if a value is out of range.
  void SetOptions(const ScanImageFusionOptions& options);

  void SetLaser(const LaserMount& mount) { laser_ = mount; }
  const LaserMount& laser() const { return laser_; }
  /// Throws std::invalid_argument if the camera can't be used; see CameraModel and BearingImage.
  /// An image that waits is dropped if it is of another size.
  void SetCamera(const CameraIntrinsics& intrinsics, const Eigen::Isometry3d& base_from_camera);
  /// From now on there is no camera.
  void RemoveCamera();
  bool has_camera() const { return bearing_image_ != nullptr; }

  /// Hands over the newest image; the next scan near it in time uses it, once. It may come before
  /// the camera, whose messages go another way: then it waits for it. Throws std::invalid_argument
  /// if its size is not that of the camera's intrinsics.
  void AddImage(const CameraImage& image);

  /// Makes the model of a scan.
  FusedModel Fuse(const LaserScan& scan);

  /// Of the last model with an image; empty image if there was none.
  const FusionEvidence& evidence() const { return evidence_; }
  /// Null without a camera.
  const BearingImage* bearing_image() const { return bearing_image_.get(); }
  const CameraModel* camera() const { return camera_.get(); }
  /// Takes points of the base frame to the camera's optical frame; with a camera.
  const Eigen::Isometry3d& camera_from_base() const { return camera_from_base_; }
  /// Where the camera sees the hits of a model, one pixel for each beam; (-1, -1): not in view.
  std::vector<cv::Point2f> BeamPixels(const FusedModel& model) const;

  /// Forgets readings and images (time went back); the mounts stay.
  void Reset();

 private:
  bool Fits(const CameraImage& image) const;
  Velocity2 SweepVelocity(const LaserScan& scan) const;
  void FuseImage(const CameraImage& image, FusedModel* model);
  Pose2 ScanFromImage(Stamp scan, Stamp image) const;
  std::vector<Eigen::Vector2d> PointsAtImage(const FusedModel& model, Stamp image) const;
  std::optional<ModelEdge> ToModelEdge(const ImageEdge& edge, const FusedModel& model,
                                       const std::vector<Eigen::Vector2d>& points, Stamp image,
                                       int beam) const;

  ScanImageFusionOptions options_;
  OdometryBuffer odometry_;
  LaserMount laser_;
  std::unique_ptr<CameraModel> camera_;
  std::unique_ptr<BearingImage> bearing_image_;
  Eigen::Isometry3d camera_from_base_ = Eigen::Isometry3d::Identity();
  std::optional<CameraImage> pending_image_;
  FusionEvidence evidence_;
};

}  // namespace scan_image_slam
