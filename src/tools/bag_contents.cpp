#include "bag_contents.h"

#include "scan_image_slam/ros/bag_input.h"
#include "scan_image_slam/ros/bag_message.h"
#include "scan_image_slam/ros/image_conversion.h"
#include "scan_image_slam/ros/sensor_conversions.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include <nav_msgs/Odometry.h>
#include <opencv2/core.hpp>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/LaserScan.h>

namespace scan_image_slam {
namespace {

constexpr std::size_t kImagesToDecode = 20;  // of each topic

/// Reads the messages of one bag into its contents.
class ContentsReader {
 public:
  explicit ContentsReader(BagContents* contents) : contents_(*contents) {}

  void Expect(const std::vector<const rosbag::ConnectionInfo*>& connections) {
    for (const rosbag::ConnectionInfo* connection : connections) {
      contents_.topics[WithSlash(connection->topic)].type = connection->datatype;
    }
  }

  void Read(const rosbag::MessageInstance& message, std::size_t messages_of_topic) {
    RecordedTopic* topic = &contents_.topics[WithSlash(message.getTopic())];
    const std::size_t index = topic->messages++;
    decode_ = index % std::max<std::size_t>(1, messages_of_topic / kImagesToDecode) == 0;
    const std::string& type = topic->type;
    try {
      if (type == kScanType) return Read<sensor_msgs::LaserScan>(message, topic);
      if (type == kImageType) return Read<sensor_msgs::Image>(message, topic);
      if (type == kCompressedImageType) {
        return Read<sensor_msgs::CompressedImage>(message, topic);
      }
      if (type == kCameraInfoType) return Read<sensor_msgs::CameraInfo>(message, topic);
      if (type == kOdometryType) return Read<nav_msgs::Odometry>(message, topic);
      ReadTransforms(message);
    } catch (const std::invalid_argument& error) {
      ++topic->refused[error.what()];
    }
  }

 private:
  template <typename Message>
  void Read(const rosbag::MessageInstance& instance, RecordedTopic* topic) {
    const auto message = ReadMessage<Message>(instance);
    if (message == nullptr) {
      throw std::invalid_argument("recorded with another definition of " + topic->type);
    }
    topic->frames.insert(StripSlash(message->header.frame_id));
    if (topic->messages == 1) topic->frame = StripSlash(message->header.frame_id);
    topic->stamps.Add(static_cast<Stamp>(message->header.stamp.toNSec()),
                      static_cast<Stamp>(instance.getTime().toNSec()));
    // What has no stamp is counted by that.
    if (!message->header.stamp.isZero()) Keep(*message, topic);
  }

  static void Keep(const sensor_msgs::LaserScan& scan, RecordedTopic* topic) {
    topic->scans.Add(ToLaserScan(scan));
  }

  static void Keep(const nav_msgs::Odometry& odometry, RecordedTopic* topic) {
    if (topic->child_frame.empty()) topic->child_frame = StripSlash(odometry.child_frame_id);
    topic->odometry.Add(ToStamp(odometry.header.stamp), ToPose2(odometry.pose.pose));
  }

  static void Keep(const sensor_msgs::CameraInfo& info, RecordedTopic* topic) {
    if (topic->calibration.intrinsics || !topic->calibration.problem.empty()) return;
    try {
      topic->calibration.intrinsics = ToCameraIntrinsics(info);
    } catch (const std::invalid_argument& error) {
      topic->calibration.problem = error.what();
    }
  }

  void Keep(const sensor_msgs::Image& image, RecordedTopic* topic) const {
    if (!decode_) return;
    if (image.encoding == "16UC1" || image.encoding == "32FC1") {
      topic->images.AddUnreadable("depths (" + image.encoding + "), no picture");
      return;
    }
    if (!KeepPicture([&] { return ToGrey(image); }, image.encoding, topic)) return;
    if (image.encoding != "mono8" && image.encoding != "8UC1") return;
    const cv::Mat view(static_cast<int>(image.height), static_cast<int>(image.width), CV_8U,
                       const_cast<std::uint8_t*>(image.data.data()), image.step);
    if (LooksLikeBayer(view)) topic->images.AddBayer();
  }

  void Keep(const sensor_msgs::CompressedImage& image, RecordedTopic* topic) const {
    if (!decode_) return;
    if (image.format.find("compressedDepth") != std::string::npos) {
      topic->images.AddUnreadable("depths (" + image.format + "), no picture");
      return;
    }
    KeepPicture([&] { return ToGrey(image); }, image.format, topic);
  }

  /// True if it can be decoded.
  static bool KeepPicture(const std::function<cv::Mat()>& decode, const std::string& encoding,
                          RecordedTopic* topic) {
    try {
      const cv::Mat grey = decode();
      topic->images.Add(grey.cols, grey.rows, encoding, cv::mean(grey)[0]);
      return true;
    } catch (const std::invalid_argument& error) {
      topic->images.AddUnreadable(error.what());
      return false;
    }
  }

  void ReadTransforms(const rosbag::MessageInstance& instance) {
    const std::vector<std::string>& names = TransformTopics();
    if (std::find(names.begin(), names.end(), WithSlash(instance.getTopic())) == names.end())
      return;
    const auto message = ReadMessage<tf2_msgs::TFMessage>(instance);
    if (message != nullptr) contents_.transforms.Add(*message, instance.getTime());
  }

  BagContents& contents_;
  bool decode_ = false;  ///< the image at hand
};

}  // namespace

std::vector<std::string> BagContents::TopicsOfType(const std::string& type) const {
  std::vector<std::string> names;
  for (const auto& [name, topic] : topics) {
    if (topic.type == type) names.push_back(name);
  }
  return names;
}

std::vector<std::string> BagContents::ImageTopics() const {
  std::vector<std::string> names = TopicsOfType(kImageType);
  const std::vector<std::string> compressed = TopicsOfType(kCompressedImageType);
  names.insert(names.end(), compressed.begin(), compressed.end());
  return names;
}

BagContents ReadBagContents(const std::string& path, const std::function<void(double)>& progress) {
  BagContents contents;
  contents.path = path;
  rosbag::Bag bag;
  OpenBag(path, &bag);
  contents.megabytes = static_cast<double>(std::filesystem::file_size(path)) / 1e6;
  ContentsReader reader(&contents);
  try {
    rosbag::View view(bag);
    if (view.size() == 0) throw BagError(path + ": the bag holds no messages");
    contents.begin = view.getBeginTime();
    contents.end = view.getEndTime();
    reader.Expect(view.getConnections());
    std::map<std::string, std::size_t> messages;
    for (const auto& [name, topic] : contents.topics) {
      messages[name] = rosbag::View(bag, WithOrWithoutSlash({name})).size();
    }
    double done = 0.0;
    for (const rosbag::MessageInstance& message : view) {
      reader.Read(message, messages[WithSlash(message.getTopic())]);
      progress(++done / view.size());
    }
  } catch (const rosbag::BagException& error) {
    throw BagError(path + ": damaged: " + error.what());
  }
  contents.mounts = contents.transforms.MakeBuffer();
  return contents;
}

}  // namespace scan_image_slam
