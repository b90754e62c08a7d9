#pragma once

#include "scan_image_slam/core/calibration/jump_sight.h"
#include "scan_image_slam/core/config/node_options.h"
#include "scan_image_slam/core/sensor/camera_model.h"

#include <Eigen/Geometry>

namespace scan_image_slam {

/// base_from_camera (optical frame) with a correction applied.
Eigen::Isometry3d Corrected(const Eigen::Isometry3d& base_from_camera,
                            const CalibrationVector& correction);

/// The pose of a camera as parameters tell it, from that of its optical frame (x right, y down, z
/// forward).
SensorPose CameraPose(const Eigen::Isometry3d& base_from_camera);

/// Row of the picture in which the laser's plane, `laser_height` above the base, is seen at a
/// distance straight ahead of the camera [px]; NaN if it is not in the picture.
double RowOfLaserPlane(const CameraModel& camera, const Eigen::Isometry3d& base_from_camera,
                       double laser_height, double distance);

}  // namespace scan_image_slam
