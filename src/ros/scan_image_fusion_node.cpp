#include "scan_image_slam/ros/scan_image_fusion_node.h"

#include "scan_image_slam/core/pipeline/fusion_picture.h"
#include "scan_image_slam/core/recording/number_text.h"
#include "scan_image_slam/ros/image_conversion.h"
#include "scan_image_slam/ros/node_parameters.h"
#include "scan_image_slam/ros/publish_shared.h"
#include "scan_image_slam/ros/sensor_conversions.h"
#include "scan_image_slam/ros/slam_messages.h"
#include <scan_image_slam/IcpModel.h>

#include <cmath>
#include <stdexcept>
#include <utility>

#include <cv_bridge/cv_bridge.h>
#include <ros/console.h>
#include <visualization_msgs/MarkerArray.h>

namespace scan_image_slam {
namespace {

constexpr std::uint32_t kScanQueue = 20;  // half a second at the usual rates
constexpr std::uint32_t kImageQueue = 2;
constexpr std::size_t kMaxWaitingScans = 20;
constexpr double kEdgeHeight = 1.0;    // of a drawn edge [m]
constexpr double kMisfitPeriod = 5.0;  // between two looks at the calibration [s]
constexpr double kCameraGone = 20.0;   // it may be another, or elsewhere, when it is back [s]
constexpr char kMisfit[] = "camera calibration";

/// When the last beam was measured, before which no driver can tell of the scan [ns].
std::uint64_t EndOf(const sensor_msgs::LaserScan& scan) {
  const std::uint64_t begin = scan.header.stamp.toNSec();
  const double sweep = static_cast<double>(scan.time_increment) * scan.ranges.size();
  if (begin == 0 || !(sweep > 0.0 && sweep < kLongestSweep)) return begin;
  return begin + static_cast<std::uint64_t>(1e9 * sweep);
}

std_msgs::ColorRGBA EdgeColour(int sign) {
  std_msgs::ColorRGBA colour;
  colour.r = sign > 0 ? 1.0f : 0.0f;
  colour.g = sign > 0 ? 0.55f : 0.78f;
  colour.b = sign > 0 ? 0.0f : 1.0f;
  colour.a = 1.0f;
  return colour;
}

/// What is wrong with the camera's calibration beyond doubt; empty: nothing.
std::string Describe(const CameraMisfit& misfit) {
  constexpr double kYaw = 0.3 * M_PI / 180.0;  // tolerated [rad]
  constexpr double kTime = 0.01;               // tolerated [s]
  constexpr double kCertain = 3.0;             // standard deviations
  const auto beyond = [](double value, double tolerated, double stddev) {
    return std::abs(value) > tolerated + kCertain * stddev;
  };
  std::string text;
  if (beyond(misfit.yaw, kYaw, misfit.yaw_stddev)) {
    text = "looked " + NumberText(Degrees(std::abs(misfit.yaw)), 1) + " deg farther to the " +
           (misfit.yaw > 0.0 ? "left" : "right");
  }
  if (beyond(misfit.time_offset, kTime, misfit.time_offset_stddev)) {
    text += (text.empty() ? "" : " and ") + std::string("took its pictures ") +
            NumberText(1e3 * std::abs(misfit.time_offset), 0) + " ms " +
            (misfit.time_offset > 0.0 ? "later" : "earlier");
  }
  if (text.empty()) return "";
  return "edges lie beside the objects that the laser sees, as if the camera " + text +
         " than it says: calibrate_camera_laser finds what is wrong";
}

}  // namespace

ScanImageFusionNode::Options ScanImageFusionNode::ReadOptions(const ros::NodeHandle& private_node) {
  Options options;
  ParameterSet set = options.Parameters();
  ReadParameters(private_node, &set);
  try {
    options.fusion.Validate();
  } catch (const std::invalid_argument& error) {
    throw ParameterError(private_node.getNamespace() + "/" + error.what());
  }
  return options;
}

ScanImageFusionNode::ScanImageFusionNode(ros::NodeHandle node, ros::NodeHandle private_node)
    : node_(node),
      options_(ReadOptions(private_node)),
      fusion_(options_.fusion),
      gate_(options_.node.odometry.max_wait, kMaxWaitingScans,
            options_.node.odometry.source != OdometrySource::kNone),
      watch_(node, private_node),
      tf_listener_(tf_, node),
      mount_broadcaster_(options_.node.publish_mounts
                             ? std::make_unique<tf2_ros::StaticTransformBroadcaster>()
                             : nullptr),
      laser_mount_("laser", options_.node.laser, false, options_.node.odometry.base_frame, &tf_,
                   &watch_, mount_broadcaster_.get()),
      camera_mount_("camera", options_.node.camera, true, options_.node.odometry.base_frame, &tf_,
                    &watch_, mount_broadcaster_.get()),
      wake_up_(node, [this] { ReleaseScans(); }),
      live_parameters_(private_node, Options().Parameters(), options_.Parameters(),
                       [this](const LiveParameters::Values& values) { Take(values); }) {
  model_publisher_ = node.advertise<IcpModel>("icp_model", kModelQueue);
  edges_publisher_ = node.advertise<visualization_msgs::MarkerArray>("fusion/edges", 1);
  picture_publisher_ = image_transport::ImageTransport(node).advertise("fusion/image", 1);

  odometry_ = std::make_unique<OdometryFeed>(
      node, options_.node.odometry, &tf_, &watch_,
      [this](Stamp stamp, const Pose2& pose) { OnOdometry(stamp, pose); });
  if (options_.node.use_camera) SubscribeCamera(node, private_node.getNamespace());
  scan_subscriber_ = node.subscribe("scan", kScanQueue, &ScanImageFusionNode::OnScan, this,
                                    ros::TransportHints().tcpNoDelay());
  watch_.Expect(scan_subscriber_, "sensor_msgs/LaserScan", false);
  watch_.AddValue("scans dropped while waiting for encoders",
                  [this] { return std::to_string(gate_.dropped()); });
  watch_.AddValue("fusion [ms]", [this] { return fusion_time_.Text(); });
  watch_.AddValue("camera yaw by edges on objects [deg]", [this] {
    return misfit_ ? NumberText(Degrees(misfit_->yaw), 2) : std::string("not known");
  });
  watch_.AddValue("camera time offset by edges on objects [ms]", [this] {
    return misfit_ ? NumberText(1e3 * misfit_->time_offset, 0) : std::string("not known");
  });
}

/// A user has changed parameters: they count from the next scan on.
void ScanImageFusionNode::Take(const LiveParameters::Values& values) {
  Options options = options_;
  options.Parameters().Set(values);
  fusion_.SetOptions(options.fusion);
  gate_.set_max_wait(options.node.odometry.max_wait);
  if (options.fusion.camera_time_offset != options_.fusion.camera_time_offset) ForgetCalibration();
  options_ = options;
}

void ScanImageFusionNode::SubscribeCamera(ros::NodeHandle node, const std::string& name) {
  camera_info_subscriber_ =
      node.subscribe("camera_info", kImageQueue, &ScanImageFusionNode::OnCameraInfo, this);
  watch_.Expect(camera_info_subscriber_, "sensor_msgs/CameraInfo", true);
  const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
  if (options_.node.image_transport == "compressed") {
    // Not every distribution has the plugin for it.
    compressed_subscriber_ = node.subscribe("image_raw/compressed", kImageQueue,
                                            &ScanImageFusionNode::OnCompressedImage, this, hints);
    watch_.Expect(compressed_subscriber_, "sensor_msgs/CompressedImage", true);
    return;
  }
  try {
    image_subscriber_ = image_transport::ImageTransport(node).subscribe(
        "image_raw", kImageQueue, &ScanImageFusionNode::OnImage, this,
        image_transport::TransportHints(options_.node.image_transport, hints));
  } catch (const image_transport::TransportLoadException& error) {
    throw ParameterError(name + "/image_transport: " + error.what());
  }
  watch_.Expect(
      image_subscriber_.getTopic(), [this] { return image_subscriber_.getNumPublishers(); },
      "sensor_msgs/Image", true);
}

void ScanImageFusionNode::OnOdometry(Stamp stamp, const Pose2& odom_from_base) {
  if (fusion_.AddOdometry(stamp, odom_from_base) == OdometryBuffer::Result::kReset) {
    ROS_WARN("the odometry jumped: taken as a reset of the encoders, not as a motion");
  }
  ReleaseScans();
}

void ScanImageFusionNode::OnScan(const ros::MessageEvent<const sensor_msgs::LaserScan>& event) {
  const std::string topic = scan_subscriber_.getTopic();
  const sensor_msgs::LaserScanConstPtr& message = event.getConstMessage();
  watch_.Arrived(topic, EndOf(*message), message->header.seq);
  if (!watch_.InTime(topic, event.getReceiptTime())) return;
  try {
    const LaserScan scan = ToLaserScan(*message);
    switch (time_guard_.Check(scan.stamp, ClockNow(), ros::Time::isSimTime())) {
      case TimeGuard::Verdict::kStale:
        throw std::invalid_argument("its stamp is not later than that of the scan before");
      case TimeGuard::Verdict::kAhead:
        throw std::invalid_argument(
            "its stamp leaps ahead of the clock: set the clock of the machine it comes from");
      case TimeGuard::Verdict::kRestarts:
        StartOver();
        break;
      case TimeGuard::Verdict::kAdvances:
        break;
    }
    if (!laser_mount_.Update(message->header.frame_id)) return;
    if (laser_mount_.changed()) ForgetCalibration();
    fusion_.SetLaser(LaserMount::From(laser_mount_.base_from_sensor()));
    gate_.Push(scan, scan.stamp, SteadyNow());
    ReleaseScans();
  } catch (const std::invalid_argument& error) {
    watch_.Refuse(topic, error.what());
  }
}

void ScanImageFusionNode::StartOver() {
  ROS_WARN("time went back: starting over");
  fusion_.Reset();
  gate_.Clear();
  ForgetCalibration();
}

void ScanImageFusionNode::OnCameraInfo(const sensor_msgs::CameraInfoConstPtr& message) {
  const std::string topic = camera_info_subscriber_.getTopic();
  watch_.Arrived(topic, 0);  // calibrations are not of a moment
  try {
    if (!camera_mount_.Update(message->header.frame_id)) {
      LoseCamera();
      return;
    }
    sensor_msgs::CameraInfo calibration = *message;
    calibration.header = std_msgs::Header();
    std::ostringstream text;
    text << calibration;
    if (!camera_mount_.changed() && text.str() == camera_info_text_) return;
    fusion_.SetCamera(ToCameraIntrinsics(*message), camera_mount_.base_from_sensor());
    camera_info_text_ = text.str();
    ForgetCalibration();
    watch_.SetProblem(topic, "");
  } catch (const std::invalid_argument& error) {
    watch_.SetProblem(topic, std::string(error.what()) + "; going on without the camera");
    LoseCamera();
  }
}

void ScanImageFusionNode::LoseCamera() {
  fusion_.RemoveCamera();
  camera_info_text_.clear();
  ForgetCalibration();
}

void ScanImageFusionNode::OnImage(const sensor_msgs::ImageConstPtr& message) {
  watch_.Arrived(image_subscriber_.getTopic(), message->header.stamp.toNSec());
  try {
    fusion_.AddImage({ToStamp(message->header.stamp), ToGrey(*message), ToStdPointer(message)});
  } catch (const std::invalid_argument& error) {
    watch_.Refuse(image_subscriber_.getTopic(), error.what());
  }
}

void ScanImageFusionNode::OnCompressedImage(const sensor_msgs::CompressedImageConstPtr& message) {
  watch_.Arrived(compressed_subscriber_.getTopic(), message->header.stamp.toNSec());
  try {
    fusion_.AddImage({ToStamp(message->header.stamp), ToGrey(*message), nullptr});
  } catch (const std::invalid_argument& error) {
    watch_.Refuse(compressed_subscriber_.getTopic(), error.what());
  }
}

void ScanImageFusionNode::ReleaseScans() {
  while (const auto scan = gate_.Pop(SteadyNow(), fusion_.odometry())) {
    PublishPicture(nullptr);  // if its match has not come, it is not waited for any longer
    Publish(fusion_time_.Measure([&] { return fusion_.Fuse(*scan); }));
  }
  // The next one is looked at again when its time is up, though nothing arrives.
  wake_up_.In(gate_.TimeLeft(SteadyNow()));
}

void ScanImageFusionNode::Publish(const FusedModel& model) {
  PublishShared(model_publisher_, ToMessage(model, options_.node.odometry.base_frame));
  if (!model.has_image) {
    if (misfit_stamp_ != 0 && Seconds(model.stamp - misfit_stamp_) > kCameraGone) {
      ForgetCalibration();
    }
    return;
  }
  PreparePicture(model);
  if (edges_publisher_.getNumSubscribers() > 0) PublishEdges(model);
  WatchCalibration(model);
}

void ScanImageFusionNode::WatchCalibration(const FusedModel& model) {
  calibration_watch_.Add(fusion_, model);
  if (Seconds(model.stamp - misfit_stamp_) < kMisfitPeriod) return;
  misfit_stamp_ = model.stamp;
  misfit_ = calibration_watch_.Misfit();
  if (misfit_) watch_.SetProblem(kMisfit, Describe(*misfit_));
}

/// What was seen belongs to another calibration, or to another time.
void ScanImageFusionNode::ForgetCalibration() {
  to_draw_.reset();
  calibration_watch_ = CalibrationWatch();
  misfit_.reset();
  misfit_stamp_ = 0;
  watch_.ForgetProblem(kMisfit);
}

/// The picture shows what became of the edges, too: it is drawn when the match is known, if there
/// is to be one.
void ScanImageFusionNode::PreparePicture(const FusedModel& model) {
  if (picture_publisher_.getNumSubscribers() == 0) {
    match_subscriber_.shutdown();
    return;
  }
  to_draw_ = model;
  if (!match_subscriber_) {
    match_subscriber_ = node_.subscribe("scan_match", kModelQueue, &ScanImageFusionNode::OnMatch,
                                        this, ros::TransportHints().tcpNoDelay());
  }
  if (match_subscriber_.getNumPublishers() == 0) PublishPicture(nullptr);
}

void ScanImageFusionNode::OnMatch(const ScanMatchConstPtr& message) {
  try {
    const MatchedMotion match = FromMessage(*message);
    if (to_draw_ && match.stamp == to_draw_->stamp) PublishPicture(&match);
  } catch (const std::invalid_argument& error) {
    watch_.Refuse(match_subscriber_.getTopic(), error.what());
  }
}

/// Null: without what the matching says.
void ScanImageFusionNode::PublishPicture(const MatchedMotion* match) {
  if (!to_draw_) return;
  const FusedModel model = *std::exchange(to_draw_, std::nullopt);
  cv_bridge::CvImage picture;
  picture.header.stamp = ToRosTime(fusion_.evidence().image.stamp);
  picture.header.frame_id = camera_mount_.sensor_frame();
  picture.encoding = "bgr8";
  picture.image = DrawFusion(fusion_, model, match);
  picture_publisher_.publish(picture.toImageMsg());
}

void ScanImageFusionNode::PublishEdges(const FusedModel& model) {
  visualization_msgs::Marker marker;
  marker.header.stamp = ToRosTime(model.stamp);
  marker.header.frame_id = options_.node.odometry.base_frame;
  marker.ns = "edges";
  marker.type = visualization_msgs::Marker::LINE_LIST;
  marker.scale.x = 0.02;
  marker.pose.orientation.w = 1.0;
  marker.lifetime = ros::Duration(0.2);
  for (const ModelEdge& edge : model.edges) {
    geometry_msgs::Point point;
    point.x = edge.point().x();
    point.y = edge.point().y();
    marker.points.push_back(point);
    point.z = kEdgeHeight;
    marker.points.push_back(point);
    marker.colors.insert(marker.colors.end(), 2, EdgeColour(edge.sign));
  }
  visualization_msgs::MarkerArray array;
  array.markers.push_back(marker);
  PublishShared(edges_publisher_, std::move(array));
}

}  // namespace scan_image_slam
