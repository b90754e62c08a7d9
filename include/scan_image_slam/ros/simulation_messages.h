#pragma once

#include "scan_image_slam/core/simulation/robot_simulation.h"

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <nav_msgs/Odometry.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/LaserScan.h>
#include <tf2_msgs/TFMessage.h>

namespace scan_image_slam {

// What the simulated robot measures, as its drivers would publish it. Frames: odom, base_link,
// laser, camera_optical_frame.

sensor_msgs::LaserScan ToMessage(const LaserScan& scan, double scan_time);
nav_msgs::Odometry ToMessage(const OdometryReading& reading);
/// odom -> base_link of a reading.
geometry_msgs::TransformStamped ToTransform(const OdometryReading& reading);
sensor_msgs::CameraInfo ToMessage(const CameraLens& lens, Stamp stamp);
sensor_msgs::Image ToMessage(const CameraFrame& frame);
std::string EncodingName(ImageEncoding encoding);
/// base_link -> laser and base_link -> camera_optical_frame, as the robot's description says.
tf2_msgs::TFMessage StaticTransforms(const RobotSimulation& simulation, Stamp stamp);
/// For evaluation only. Frame: world.
geometry_msgs::PoseStamped ToMessage(const GroundTruth& truth);

}  // namespace scan_image_slam
