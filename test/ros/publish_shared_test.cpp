#include "scan_image_slam/ros/publish_shared.h"

#include "spin_until.h"
#include <scan_image_slam/IcpModel.h>

#include <utility>

#include <gtest/gtest.h>
#include <ros/ros.h>

namespace scan_image_slam {
namespace {

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
