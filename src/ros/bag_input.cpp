#include "scan_image_slam/ros/bag_input.h"

#include "scan_image_slam/core/recording/number_text.h"
#include "scan_image_slam/ros/bag_check.h"
#include "scan_image_slam/ros/bag_message.h"
#include "scan_image_slam/ros/image_conversion.h"
#include "scan_image_slam/ros/recorded_transforms.h"
#include "scan_image_slam/ros/sensor_conversions.h"
#include "scan_image_slam/ros/sensor_frames.h"

#include <algorithm>
#include <fstream>

#include <nav_msgs/Odometry.h>
#include <rosbag/view.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/LaserScan.h>
#include <tf2/buffer_core.h>
#include <tf2_msgs/TFMessage.h>

namespace scan_image_slam {
void OpenBag(const std::string& path, rosbag::Bag* bag) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) throw BagError(path + ": can't be opened for reading");
  const auto size = static_cast<long long>(file.tellg());
  if (size == 0) throw BagError(path + ": the file is empty");
  try {
    CheckBag(path);
    bag->open(path, rosbag::bagmode::Read);
  } catch (const rosbag::BagUnindexedException&) {
    throw BagError(path + ": the bag has no index; it ends at byte " + std::to_string(size) +
                   " as if the recording had been cut off (rosbag reindex mends that)");
  } catch (const std::runtime_error& error) {
    throw BagError(path + ": not a readable bag (" + std::to_string(size) +
                   " bytes): " + error.what());
  }
}

std::string WithSlash(const std::string& topic) {
  return topic.empty() || topic.front() == '/' ? topic : "/" + topic;
}

rosbag::TopicQuery WithOrWithoutSlash(const std::vector<std::string>& topics) {
  std::vector<std::string> names = topics;
  for (const std::string& topic : topics) names.push_back(topic.substr(1));
  return rosbag::TopicQuery(names);
}

const std::vector<std::string>& TransformTopics() {
  static const std::vector<std::string> kTopics = {"/tf", "/tf_static"};
  return kTopics;
}

BagInput::~BagInput() = default;

BagInput::BagInput(const std::string& path, const BagTopics& topics, const SlamOptions& options)
    : path_(path), options_(options) {
  OpenBag(path, &bag_);
  try {
    rosbag::View all(bag_);
    for (const rosbag::ConnectionInfo* connection : all.getConnections()) {
      // Older recordings hold transforms under the type of the first tf, with the same content.
      type_of_[WithSlash(connection->topic)] =
          connection->datatype == "tf/tfMessage" ? "tf2_msgs/TFMessage" : connection->datatype;
    }
    if (all.size() == 0) throw BagError(path + ": the bag holds no messages");
    ChooseTopics(topics);
    ReadTransforms();
    ChooseBaseFrame();
    CheckFrames();
  } catch (const rosbag::BagException& error) {
    throw BagError(path + ": damaged: " + error.what());
  } catch (const std::invalid_argument& error) {
    throw BagError(path + ": damaged: " + error.what());
  }
}

std::vector<std::string> BagInput::TopicsOfType(const std::string& type) const {
  std::vector<std::string> topics;
  for (const auto& [topic, its_type] : type_of_) {
    if (its_type == type) topics.push_back(topic);
  }
  return topics;
}

/// The wanted topic; without a wish the usual one, or the only one of its type, or none.
std::string BagInput::Choose(const std::string& wanted, const std::string& usual,
                             const std::string& type, const std::string& option) const {
  const std::vector<std::string> candidates = TopicsOfType(type);
  if (!wanted.empty()) {
    std::string topic = WithSlash(wanted);
    if (std::find(candidates.begin(), candidates.end(), topic) != candidates.end()) return topic;
    throw BagError(path_ + ": there is no topic " + topic + " of type " + type + " (" + option +
                   "); topics of this type: " + ListText(candidates));
  }
  if (std::find(candidates.begin(), candidates.end(), usual) != candidates.end()) return usual;
  return candidates.size() == 1 ? candidates.front() : "";
}

void BagInput::ChooseTopics(const BagTopics& topics) {
  scan_topic_ = Choose(topics.scan, "/scan", kScanType, "--scan-topic");
  if (scan_topic_.empty()) {
    throw BagError(path_ + ": there is no topic /scan; topics of type " + kScanType + ": " +
                   ListText(TopicsOfType(kScanType)) + " (choose one with --scan-topic)");
  }
  notes_.push_back("scans: " + scan_topic_);

  const OdometrySource source = options_.fusion_node.odometry.source;
  if (source == OdometrySource::kAuto || source == OdometrySource::kTopic) {
    odom_topic_ = Choose(topics.odom, "/odom", kOdometryType, "--odom-topic");
  }
  odometry_from_tf_ = odom_topic_.empty() &&
                      (source == OdometrySource::kAuto || source == OdometrySource::kTf) &&
                      type_of_.count("/tf") != 0;

  if (!topics.use_images) return;
  const std::string raw = Choose("", "/image_raw", kImageType, "--image-topic");
  const std::string compressed =
      Choose("", "/image_raw/compressed", kCompressedImageType, "--image-topic");
  image_topic_ = raw.empty() ? compressed : raw;
  if (!topics.image.empty()) {
    const std::string wanted = WithSlash(topics.image);
    const bool is_compressed =
        type_of_.count(wanted) == 0 || type_of_[wanted] == kCompressedImageType;
    image_topic_ =
        is_compressed && type_of_.count(wanted) == 0
            ? Choose(wanted + kCompressedEnding, "", kCompressedImageType, "--image-topic")
            : Choose(wanted, "", is_compressed ? kCompressedImageType : kImageType,
                     "--image-topic");
  }
  camera_info_topic_ =
      Choose(topics.camera_info, "/camera_info", kCameraInfoType, "--camera-info-topic");
  if (!image_topic_.empty() && camera_info_topic_.empty()) {
    throw BagError(path_ + ": there are images on " + image_topic_ +
                   " but no topic /camera_info; topics of type " + kCameraInfoType + ": " +
                   ListText(TopicsOfType(kCameraInfoType)) +
                   " (choose one with --camera-info-topic, or use --no-images)");
  }
  notes_.push_back("images: " + (image_topic_.empty() ? NoImages() : image_topic_));
}

/// Says of which topic images could be used.
std::string BagInput::NoImages() const {
  std::vector<std::string> topics = TopicsOfType(kImageType);
  const std::vector<std::string> compressed = TopicsOfType(kCompressedImageType);
  topics.insert(topics.end(), compressed.begin(), compressed.end());
  if (topics.empty()) return "none";
  return "none; there are several topics of images, choose one with --image-topic: " +
         ListText(topics);
}

void BagInput::ReadTransforms() {
  RecordedTransforms transforms;
  rosbag::View view(bag_, WithOrWithoutSlash(TransformTopics()));
  for (const rosbag::MessageInstance& instance : view) {
    const auto message = ReadMessage<tf2_msgs::TFMessage>(instance);
    if (message != nullptr) transforms.Add(*message, instance.getTime());
  }
  mounts_ = transforms.MakeBuffer();
}

std::string BagInput::FirstFrame(const std::string& topic) const {
  rosbag::View view(bag_, WithOrWithoutSlash({topic}));
  for (const rosbag::MessageInstance& instance : view) {
    if (const auto scan = ReadMessage<sensor_msgs::LaserScan>(instance)) {
      return StripSlash(scan->header.frame_id);
    }
    if (const auto info = ReadMessage<sensor_msgs::CameraInfo>(instance)) {
      return StripSlash(info->header.frame_id);
    }
    if (const auto odometry = ReadMessage<nav_msgs::Odometry>(instance)) {
      return StripSlash(odometry->child_frame_id);
    }
    throw BagError(path_ + ": topic " + topic + " was recorded with another definition of " +
                   instance.getDataType());
  }
  throw BagError(path_ + ": topic " + topic + " holds no messages");
}

void BagInput::ChooseBaseFrame() {
  base_frame_ = StripSlash(options_.fusion_node.odometry.base_frame);
  const std::string laser_frame = FirstFrame(scan_topic_);
  if (!options_.fusion_node.laser.from_tf ||
      LookUpSensor(*mounts_, base_frame_, laser_frame).found) {
    return;
  }
  if (base_frame_ != OdometryInput{}.base_frame) return;  // what was asked for is not guessed
  const std::string driven = odom_topic_.empty() ? "" : FirstFrame(odom_topic_);
  if (!driven.empty() && LookUpSensor(*mounts_, driven, laser_frame).found) {
    notes_.push_back("base frame: " + driven + " (of " + odom_topic_ + "), as there is no " +
                     base_frame_);
    base_frame_ = driven;
  } else if (type_of_.count("/tf") == 0 && type_of_.count("/tf_static") == 0) {
    notes_.push_back("base frame: " + laser_frame +
                     " (of the scans), as there are no transforms: the laser is taken to be at the "
                     "base, looking forward (parameters scan_image_fusion/laser/...)");
    base_frame_ = laser_frame;
  }
}

void BagInput::CheckFrames() {
  if (options_.fusion_node.laser.from_tf) {
    const FrameLookup laser = LookUpSensor(*mounts_, base_frame_, FirstFrame(scan_topic_));
    if (!laser.found) {
      throw BagError(path_ + ": laser: " + laser.problem +
                     " (choose the base with --base-frame, or give the laser's pose by the "
                     "parameters scan_image_fusion/laser/...)");
    }
  }
  const std::string encoders = odometry_from_tf_ ? "/tf" : odom_topic_;
  notes_.push_back("encoders: " + (encoders.empty() ? "none, constant velocity" : encoders));
  if (image_topic_.empty()) return;
  if (!options_.fusion_node.camera.from_tf) {
    base_from_camera_ = ToOpticalIsometry(options_.fusion_node.camera);
    return;
  }
  const FrameLookup camera = LookUpSensor(*mounts_, base_frame_, FirstFrame(camera_info_topic_));
  if (!camera.found) {
    throw BagError(path_ + ": camera: " + camera.problem +
                   " (give its pose by the parameters scan_image_fusion/camera/..., or use "
                   "--no-images)");
  }
  base_from_camera_ = camera.base_from_sensor;
}

void BagInput::Play(SlamPipeline* pipeline, const SlamPipeline::RunStage& run,
                    const std::function<void(double)>& progress) {
  const Eigen::Isometry3d base_from_laser =
      options_.fusion_node.laser.from_tf
          ? LookUpSensor(*mounts_, base_frame_, FirstFrame(scan_topic_)).base_from_sensor
          : ToIsometry(options_.fusion_node.laser);
  try {
    pipeline->fusion().SetLaser(LaserMount::From(base_from_laser));
  } catch (const std::invalid_argument& error) {
    throw BagError(path_ + ": " + error.what());
  }
  std::vector<std::string> topics = {scan_topic_};
  if (!odom_topic_.empty()) topics.push_back(odom_topic_);
  if (odometry_from_tf_) topics.push_back("/tf");
  if (!image_topic_.empty()) topics.insert(topics.end(), {image_topic_, camera_info_topic_});
  try {
    rosbag::View view(bag_, WithOrWithoutSlash(topics));
    const double total = std::max<double>(1.0, view.size());
    double done = 0.0;
    for (const rosbag::MessageInstance& message : view) {
      const std::string topic = WithSlash(message.getTopic());
      try {
        if (topic == scan_topic_) {
          PlayScan(message, pipeline);
        } else if (topic == odom_topic_) {
          PlayOdometry(message, pipeline);
        } else if (topic == camera_info_topic_) {
          PlayCameraInfo(message, pipeline);
        } else if (topic == image_topic_) {
          PlayImage(message, pipeline, run);
        } else {
          PlayTransforms(message, pipeline);
        }
      } catch (const std::invalid_argument& error) {
        ++refused_[topic + ": " + error.what()];
      }
      progress(++done / total);
    }
  } catch (const rosbag::BagException& error) {
    throw BagError(path_ + ": damaged: " + error.what());
  }
  pipeline->Finish();
}

void BagInput::PlayScan(const rosbag::MessageInstance& message, SlamPipeline* pipeline) {
  const auto scan = ReadMessage<sensor_msgs::LaserScan>(message);
  if (scan == nullptr) return;
  pipeline->AddScan(ToLaserScan(*scan), static_cast<Stamp>(message.getTime().toNSec()));
}

void BagInput::PlayOdometry(const rosbag::MessageInstance& message, SlamPipeline* pipeline) {
  const auto odometry = ReadMessage<nav_msgs::Odometry>(message);
  if (odometry == nullptr) return;
  // It may tell the pose of another of the base's frames; unknown ones are taken for the base.
  const std::string child = StripSlash(odometry->child_frame_id);
  if (driven_frame_ != child) {
    const FrameLookup base_from_driven =
        LookUpOnBase(*mounts_, base_frame_, child, odometry->header.frame_id);
    driven_from_base_ = ToPose2(base_from_driven.base_from_sensor).Inverse();
    driven_frame_ = child;
  }
  pipeline->AddOdometry(ToStamp(odometry->header.stamp),
                        ToPose2(odometry->pose.pose) * driven_from_base_,
                        static_cast<Stamp>(message.getTime().toNSec()));
}

void BagInput::PlayTransforms(const rosbag::MessageInstance& message, SlamPipeline* pipeline) {
  const auto transforms = ReadMessage<tf2_msgs::TFMessage>(message);
  if (transforms == nullptr) return;
  const std::string odom_frame = StripSlash(options_.fusion_node.odometry.odom_frame);
  for (const geometry_msgs::TransformStamped& transform : transforms->transforms) {
    if (StripSlash(transform.header.frame_id) != odom_frame) continue;
    const FrameLookup child_from_base =
        LookUpSensor(*mounts_, StripSlash(transform.child_frame_id), base_frame_);
    if (!child_from_base.found) continue;
    pipeline->AddOdometry(ToStamp(transform.header.stamp),
                          ToPose2(Eigen::Isometry3d(ToIsometry(transform.transform) *
                                                    child_from_base.base_from_sensor)),
                          static_cast<Stamp>(message.getTime().toNSec()));
  }
}

void BagInput::PlayCameraInfo(const rosbag::MessageInstance& message, SlamPipeline* pipeline) {
  if (camera_set_) return;
  const auto info = ReadMessage<sensor_msgs::CameraInfo>(message);
  if (info == nullptr) return;
  pipeline->fusion().SetCamera(ToCameraIntrinsics(*info), *base_from_camera_);
  camera_set_ = true;
}

void BagInput::PlayImage(const rosbag::MessageInstance& message, SlamPipeline* pipeline,
                         const SlamPipeline::RunStage& run) {
  CameraImage image;
  run(Stage::kFusion, [&] {
    if (const auto raw = ReadMessage<sensor_msgs::Image>(message)) {
      image = {ToStamp(raw->header.stamp), ToGrey(*raw), ToStdPointer(raw)};
    } else if (const auto compressed = ReadMessage<sensor_msgs::CompressedImage>(message)) {
      image = {ToStamp(compressed->header.stamp), ToGrey(*compressed), nullptr};
    }
  });
  if (image.grey.empty()) return;
  pipeline->AddImage(image, static_cast<Stamp>(message.getTime().toNSec()));
  ++images_;
}

}  // namespace scan_image_slam
