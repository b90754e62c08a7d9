#pragma once

#include "bag_contents.h"
#include "scan_image_slam/core/recording/finding.h"
#include "scan_image_slam/ros/bag_input.h"

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

namespace scan_image_slam {

/// How to map with a bag: what of it to use, and under which names.
struct BagPlan {
  std::string scan;               ///< topic; empty: the bag can't be used
  std::string image;              ///< topic; empty: without camera
  bool camera_works_live = true;  ///< bag.launch can play the images
  std::string camera_info;        ///< topic
  std::string odom;               ///< topic; empty: none is used
  OdometrySource odom_source = OdometrySource::kAuto;
  std::string base_frame;
  std::string odom_frame;
  bool place_of_laser_known = true;  ///< false: it is to be written into a configuration
  std::optional<Eigen::Isometry3d> base_from_laser;
  std::optional<Eigen::Isometry3d> base_from_camera;
  /// Why sensors are left out, and what was assumed.
  Findings findings;

  bool usable() const { return !scan.empty(); }
};

/// `wanted`: topics that the user has chosen; empty ones are chosen here. Throws BagError if a
/// wanted topic isn't there.
BagPlan MakeBagPlan(const BagContents& contents, const BagTopics& wanted);

}  // namespace scan_image_slam
