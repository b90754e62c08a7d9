// The three nodes as nodelets: in one process with the drivers, images and models are not copied.

#include "scan_image_slam/ros/bounded_icp_node.h"
#include "scan_image_slam/ros/mapper_node.h"
#include "scan_image_slam/ros/scan_image_fusion_node.h"

#include <exception>
#include <memory>

#include <nodelet/nodelet.h>
#include <pluginlib/class_list_macros.hpp>
#include <ros/callback_queue.h>
#include <ros/spinner.h>

namespace scan_image_slam {

/// A node in a nodelet manager. Like a node of its own it has one thread for all its callbacks: no
/// other nodelet keeps it waiting, and none of its callbacks runs while it is taken apart.
template <typename Node>
class NodeNodelet : public nodelet::Nodelet {
 public:
  ~NodeNodelet() override { spinner_.stop(); }

 private:
  /// A wrong configuration is told, and the manager refuses to load what throws here.
  void onInit() override {
    ros::NodeHandle node = getNodeHandle();
    ros::NodeHandle private_node = getPrivateNodeHandle();
    node.setCallbackQueue(&queue_);
    private_node.setCallbackQueue(&queue_);
    try {
      node_ = std::make_unique<Node>(node, private_node);
    } catch (const std::exception& error) {
      ROS_FATAL_STREAM(error.what());
      throw;
    }
    spinner_.start();
  }

  ros::CallbackQueue queue_;
  ros::AsyncSpinner spinner_{1, &queue_};
  std::unique_ptr<Node> node_;
};

class ScanImageFusionNodelet : public NodeNodelet<ScanImageFusionNode> {};
class BoundedIcpNodelet : public NodeNodelet<BoundedIcpNode> {};
class MapperNodelet : public NodeNodelet<MapperNode> {};

}  // namespace scan_image_slam

PLUGINLIB_EXPORT_CLASS(scan_image_slam::ScanImageFusionNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(scan_image_slam::BoundedIcpNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(scan_image_slam::MapperNodelet, nodelet::Nodelet)
