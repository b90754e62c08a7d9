#include "scan_image_slam/ros/robot_simulator_node.h"
#include "scan_image_slam/ros/run_node.h"

int main(int argc, char** argv) {
  return scan_image_slam::RunNode<scan_image_slam::RobotSimulatorNode>(argc, argv,
                                                                       "robot_simulator");
}
