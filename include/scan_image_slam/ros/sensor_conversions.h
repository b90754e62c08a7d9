#pragma once

#include "scan_image_slam/core/config/node_options.h"
#include "scan_image_slam/core/geometry/pose2.h"
#include "scan_image_slam/core/sensor/camera_model.h"
#include "scan_image_slam/core/sensor/laser_scan.h"
#include "scan_image_slam/core/sensor/stamp.h"

#include <string>

#include <Eigen/Geometry>
#include <geometry_msgs/Pose.h>
#include <geometry_msgs/Transform.h>
#include <ros/time.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/LaserScan.h>

namespace scan_image_slam {

// Messages of the sensors as the core's types. All throw std::invalid_argument, saying what is
// wrong, if a message can't be used.

constexpr double kLongestSweep = 60.0;     ///< of a scan that is taken [s]
constexpr std::size_t kMaxBeams = 100000;  ///< of a scan or model that is taken

/// A stamp of zero means that a driver has set none: refused, as more nanoseconds than a second
/// has.
Stamp ToStamp(const ros::Time& time);
ros::Time ToRosTime(Stamp stamp);
/// When something has come in, by a clock that nobody sets (see OdometryGate) [ns].
Stamp SteadyNow();
/// By the clock of ROS, which is that of a bag if time is simulated; 0 before that begins [ns].
Stamp ClockNow();

/// At least one beam and at most 100000, finite angles, an increment that is not zero, a minute at
/// most.
LaserScan ToLaserScan(const sensor_msgs::LaserScan& message);

/// Finite, and near enough for a robot to be there; farther numbers would overflow in what follows.
bool IsPlausiblePosition(double x, double y);

Pose2 ToPose2(const geometry_msgs::Pose& pose);
Eigen::Isometry3d ToIsometry(const geometry_msgs::Transform& transform);
geometry_msgs::Transform ToTransformMessage(const Eigen::Isometry3d& isometry);
Pose2 ToPose2(const Eigen::Isometry3d& pose);

/// Intrinsics of the picture as it comes: with binning and the sensor's region of interest.
CameraIntrinsics ToCameraIntrinsics(const sensor_msgs::CameraInfo& message);

/// base_from_sensor of a pose that is given by parameters.
Eigen::Isometry3d ToIsometry(const SensorPose& pose);
/// The same for the optical frame (x right, y down, z forward) of a camera that looks along x.
Eigen::Isometry3d ToOpticalIsometry(const SensorPose& pose);

/// Frame names without the leading slash of older drivers.
std::string StripSlash(const std::string& frame);

}  // namespace scan_image_slam
