#include "scan_image_slam/ros/publish_shared.h"

#include <scan_image_slam/IcpModel.h>

#include <utility>

#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>

namespace scan_image_slam {
namespace {

/// Spins until the condition holds; false if it does not within ten seconds.
template <typename Condition>
bool SpinUntil(const Condition& condition) {
  const ros::WallTime deadline = ros::WallTime::now() + ros::WallDuration(10.0);
  while (!condition() && ros::WallTime::now() < deadline) {
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.01));
  }
  return condition();
}

TEST(PublishShared, HandsTheDataToASubscriberOfTheSameProcessWithoutACopy) {
  ros::NodeHandle node;
  const float* received = nullptr;
  const ros::Publisher publisher = node.advertise<IcpModel>("icp_model", 1);
  const ros::Subscriber subscriber = node.subscribe<IcpModel>(
      "icp_model", 1, [&](const IcpModelConstPtr& message) { received = message->ranges.data(); });
  ASSERT_TRUE(SpinUntil([&] { return publisher.getNumSubscribers() > 0; }));
  IcpModel model;
  model.ranges.assign(1000, 1.0f);
  const float* sent = model.ranges.data();
  PublishShared(publisher, std::move(model));
  ASSERT_TRUE(SpinUntil([&] { return received != nullptr; }));
  EXPECT_EQ(received, sent);
}

}  // namespace
}  // namespace scan_image_slam

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "publish_shared_test");
  return RUN_ALL_TESTS();
}
