#pragma once

#include <string>

#include <Eigen/Geometry>
#include <tf2/buffer_core.h>

namespace scan_image_slam {

/// Where a sensor is on the robot, or why that is not known.
struct FrameLookup {
  bool found = false;
  Eigen::Isometry3d base_from_sensor = Eigen::Isometry3d::Identity();
  std::string problem;  ///< names both frames, the frames there are, and the most similar one
};

/// The newest transform from a sensor's frame to the base; identity if they are the same frame.
FrameLookup LookUpSensor(const tf2::BufferCore& tf, const std::string& base_frame,
                         const std::string& sensor_frame);

/// The same for another frame of the base, but not by way of `odom_frame`, in which the base moves.
FrameLookup LookUpOnBase(const tf2::BufferCore& tf, const std::string& base_frame,
                         const std::string& frame, const std::string& odom_frame);

}  // namespace scan_image_slam
