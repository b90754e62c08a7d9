// A camera driver and the fusion as nodelets of one process: pixels aren't copied on their way.

#include "spin_until.h"
#include <scan_image_slam/IcpModel.h>

#include <cmath>
#include <string>

#include <boost/make_shared.hpp>
#include <geometry_msgs/TransformStamped.h>
#include <gtest/gtest.h>
#include <nodelet/loader.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/LaserScan.h>
#include <tf2_ros/static_transform_broadcaster.h>

namespace scan_image_slam {
namespace {

constexpr int kWidth = 320;
constexpr int kHeight = 240;
constexpr double kPeriod = 0.025;  // of the scans [s]

geometry_msgs::TransformStamped Mount(const std::string& sensor, bool optical) {
  geometry_msgs::TransformStamped mount;
  mount.header.frame_id = "base_link";
  mount.child_frame_id = sensor;
  mount.transform.translation.z = 0.3;
  mount.transform.rotation.w = 1.0;
  if (optical) {  // looks along the base's x (REP-103)
    mount.transform.rotation.w = 0.5;
    mount.transform.rotation.x = -0.5;
    mount.transform.rotation.y = 0.5;
    mount.transform.rotation.z = -0.5;
  }
  return mount;
}

sensor_msgs::LaserScan Scan(const ros::Time& stamp) {
  sensor_msgs::LaserScan scan;
  scan.header.stamp = stamp;
  scan.header.frame_id = "laser";
  scan.angle_min = -1.5f;
  scan.angle_max = 1.5f;
  scan.angle_increment = 0.01f;
  scan.range_min = 0.1f;
  scan.range_max = 10.0f;
  scan.ranges.assign(301, 3.0f);
  return scan;
}

sensor_msgs::CameraInfo Calibration(const ros::Time& stamp) {
  constexpr double kFocal = 250.0;  // [px]
  sensor_msgs::CameraInfo info;
  info.header.stamp = stamp;
  info.header.frame_id = "camera";
  info.width = kWidth;
  info.height = kHeight;
  info.K = {kFocal, 0, kWidth / 2.0, 0, kFocal, kHeight / 2.0, 0, 0, 1};
  info.P = {kFocal, 0, kWidth / 2.0, 0, 0, kFocal, kHeight / 2.0, 0, 0, 0, 1, 0};
  return info;
}

sensor_msgs::ImagePtr Picture(const ros::Time& stamp) {
  const auto image = boost::make_shared<sensor_msgs::Image>();
  image->header.stamp = stamp;
  image->header.frame_id = "camera";
  image->width = kWidth;
  image->height = kHeight;
  image->step = kWidth;
  image->encoding = "mono8";
  image->data.assign(kWidth * kHeight, 100);
  return image;
}

class NodeletImagesTest : public testing::Test {
 protected:
  void SetUp() override {
    mounts_.sendTransform({Mount("laser", false), Mount("camera", true)});
    ASSERT_TRUE(
        loader_.load("/scan_image_fusion", "scan_image_slam/ScanImageFusionNodelet", {}, {}));
    ASSERT_TRUE(SpinUntil([&] {
      return image_.getNumSubscribers() > 0 && scan_.getNumSubscribers() > 0 &&
             info_.getNumSubscribers() > 0;
    }));
  }

  /// Sends scans and calibrations until a model shows that the picture was looked at.
  void SendUntilFused(const sensor_msgs::ImagePtr& image) {
    fused_ = 0;
    image_.publish(sensor_msgs::ImageConstPtr(image));
    for (int i = 0; i < 400 && fused_ == 0; ++i) {
      info_.publish(Calibration(image->header.stamp));
      scan_.publish(Scan(image->header.stamp + ros::Duration(0.001 + 0.0001 * i)));
      ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(kPeriod));
    }
    ASSERT_GT(fused_, 0) << "no image was fused";
  }

  ros::NodeHandle node_;
  tf2_ros::StaticTransformBroadcaster mounts_;
  ros::Publisher image_ = node_.advertise<sensor_msgs::Image>("image_raw", 1);
  ros::Publisher info_ = node_.advertise<sensor_msgs::CameraInfo>("camera_info", 1);
  ros::Publisher scan_ = node_.advertise<sensor_msgs::LaserScan>("scan", 1);
  int fused_ = 0;  ///< models with an image
  ros::Subscriber models_ =
      node_.subscribe<IcpModel>("icp_model", 10, [this](const IcpModelConstPtr& model) {
        if (model->has_image) ++fused_;
      });
  nodelet::Loader loader_{false};
};

TEST_F(NodeletImagesTest, TheFusionLooksAtThePixelsOfTheDriver) {
  const ros::Time start(1000.0);
  const sensor_msgs::ImagePtr first = Picture(start);
  SendUntilFused(first);
  // It holds the very message for scans that may follow, and lets go when images do.
  EXPECT_GT(first.use_count(), 1);
  for (int i = 1; i <= 10; ++i) SendUntilFused(Picture(start + ros::Duration(0.1 * i)));
  EXPECT_EQ(first.use_count(), 1);
}

}  // namespace
}  // namespace scan_image_slam

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "nodelet_images_test");
  return RUN_ALL_TESTS();
}
