#pragma once

#include "scan_image_slam/core/fusion/fused_model.h"
#include "scan_image_slam/core/mapping/mapper.h"
#include "scan_image_slam/core/matching/matched_motion.h"
#include <scan_image_slam/IcpModel.h>
#include <scan_image_slam/ScanMatch.h>

#include <cstdint>
#include <string>

#include <geometry_msgs/Pose2D.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <geometry_msgs/Transform.h>

namespace scan_image_slam {

// What travels between the nodes. Conversions from messages throw std::invalid_argument, saying
// what is wrong, if a message can't be used.

constexpr std::uint32_t kModelQueue = 20;  ///< of models and matches: half a second

IcpModel ToMessage(const FusedModel& model, const std::string& base_frame);
FusedModel FromMessage(const IcpModel& message);

ScanMatch ToMessage(const MatchedMotion& match, const std::string& base_frame);
MatchedMotion FromMessage(const ScanMatch& message);

geometry_msgs::Pose2D ToPose2D(const Pose2& pose);
geometry_msgs::Pose ToPoseMessage(const Pose2& pose);
geometry_msgs::Transform ToTransformMessage(const Pose2& pose);

/// Pose with covariance in the axes of the map; what does not lie in the plane has variance 0.
geometry_msgs::PoseWithCovarianceStamped ToMessage(const MapPose& pose,
                                                   const std::string& map_frame);

}  // namespace scan_image_slam
