#pragma once

#include "scan_image_slam/core/pipeline/slam_pipeline.h"

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <rosbag/bag.h>
#include <rosbag/query.h>

namespace tf2 {
class BufferCore;
}

namespace scan_image_slam {

/// Types of the messages that are read.
constexpr char kScanType[] = "sensor_msgs/LaserScan";
constexpr char kImageType[] = "sensor_msgs/Image";
constexpr char kCompressedImageType[] = "sensor_msgs/CompressedImage";
constexpr char kCameraInfoType[] = "sensor_msgs/CameraInfo";
constexpr char kOdometryType[] = "nav_msgs/Odometry";

/// How image_transport ends the names of topics with compressed images.
constexpr char kCompressedEnding[] = "/compressed";

/// A bag that can't be used; the message names the file and what is missing or wrong.
class BagError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Which topics of a bag to use. Empty: the usual name, or the only topic of that type.
struct BagTopics {
  std::string scan;
  std::string image;
  std::string camera_info;
  std::string odom;
  bool use_images = true;
};

/// Opens a bag for reading. Throws BagError.
void OpenBag(const std::string& path, rosbag::Bag* bag);

/// Topics that hold transforms.
const std::vector<std::string>& TransformTopics();

/// Name of a topic with its leading slash, which some recorders leave out.
std::string WithSlash(const std::string& topic);
/// The messages of these topics, given with their slash, whether recorded with or without it.
rosbag::TopicQuery WithOrWithoutSlash(const std::vector<std::string>& topics);

/// Plays the sensors of a bag into a pipeline, in the order in which they were recorded.
class BagInput {
 public:
  /// Opens the bag, finds the topics and the places of the sensors. Throws BagError.
  BagInput(const std::string& path, const BagTopics& topics, const SlamOptions& options);
  ~BagInput();

  /// What was chosen and what is odd, in plain words, one line each.
  const std::vector<std::string>& notes() const { return notes_; }

  /// Plays the whole bag. `progress` gets the share that is done, 0 to 1. Throws BagError.
  void Play(SlamPipeline* pipeline, const SlamPipeline::RunStage& run,
            const std::function<void(double)>& progress);

  /// Messages that could not be used, by reason.
  const std::map<std::string, int>& refused() const { return refused_; }
  int images() const { return images_; }

 private:
  void ChooseTopics(const BagTopics& topics);
  std::string Choose(const std::string& wanted, const std::string& usual, const std::string& type,
                     const std::string& option) const;
  std::string NoImages() const;
  void ReadTransforms();
  void ChooseBaseFrame();
  void CheckFrames();
  std::string FirstFrame(const std::string& topic) const;
  std::vector<std::string> TopicsOfType(const std::string& type) const;
  void PlayOdometry(const rosbag::MessageInstance& message, SlamPipeline* pipeline);
  void PlayTransforms(const rosbag::MessageInstance& message, SlamPipeline* pipeline);
  void PlayCameraInfo(const rosbag::MessageInstance& message, SlamPipeline* pipeline);
  void PlayImage(const rosbag::MessageInstance& message, SlamPipeline* pipeline,
                 const SlamPipeline::RunStage& run);
  void PlayScan(const rosbag::MessageInstance& message, SlamPipeline* pipeline);

  std::string path_;
  rosbag::Bag bag_;
  SlamOptions options_;
  std::vector<std::string> notes_;
  std::map<std::string, std::string> type_of_;  ///< by topic
  std::string scan_topic_;
  std::string image_topic_;
  std::string camera_info_topic_;
  std::string odom_topic_;
  bool odometry_from_tf_ = false;
  std::string base_frame_;
  std::unique_ptr<tf2::BufferCore> mounts_;  ///< the usual transform between each two frames
  std::optional<Eigen::Isometry3d> base_from_camera_;
  bool camera_set_ = false;
  std::optional<std::string> driven_frame_;  ///< whose poses the encoders tell
  Pose2 driven_from_base_;
  std::map<std::string, int> refused_;
  int images_ = 0;
};

}  // namespace scan_image_slam
