#pragma once

#include "scan_image_slam/core/recording/camera_record.h"
#include "scan_image_slam/core/recording/odometry_record.h"
#include "scan_image_slam/core/recording/scan_record.h"
#include "scan_image_slam/core/recording/stamp_record.h"
#include "scan_image_slam/ros/recorded_transforms.h"

#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <ros/time.h>

namespace scan_image_slam {

/// What one topic of a bag holds. Which of the records is filled depends on its type.
struct RecordedTopic {
  std::string type;  ///< of the messages, e.g. sensor_msgs/LaserScan
  std::size_t messages = 0;
  std::string frame;             ///< of the first header, without a leading slash
  std::set<std::string> frames;  ///< of all headers
  std::string child_frame;       ///< of an odometry
  StampRecord stamps;
  ScanRecord scans;
  OdometryRecord odometry;
  ImageRecord images;
  Calibration calibration;
  std::map<std::string, int> refused;  ///< messages that can't be used, by reason
};

struct BagContents {
  std::string path;
  double megabytes = 0.0;
  ros::Time begin;
  ros::Time end;
  std::map<std::string, RecordedTopic> topics;  ///< by name
  RecordedTransforms transforms;
  std::unique_ptr<tf2::BufferCore> mounts;  ///< where the frames usually are on each other

  std::vector<std::string> TopicsOfType(const std::string& type) const;
  std::vector<std::string> ImageTopics() const;  ///< raw ones first
};

/// Reads a whole bag, but decodes only some of its images. `progress` gets the share that is done.
/// Throws BagError.
BagContents ReadBagContents(const std::string& path, const std::function<void(double)>& progress);

}  // namespace scan_image_slam
