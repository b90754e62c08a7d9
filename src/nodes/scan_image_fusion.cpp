#include "scan_image_slam/ros/run_node.h"
#include "scan_image_slam/ros/scan_image_fusion_node.h"

int main(int argc, char** argv) {
  return scan_image_slam::RunNode<scan_image_slam::ScanImageFusionNode>(argc, argv,
                                                                        "scan_image_fusion");
}
