// Messages that would spoil the pose or the map, or end a node, are refused with a reason.
#include "scan_image_slam/ros/sensor_conversions.h"
#include "scan_image_slam/ros/slam_messages.h"

#include <functional>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// What the conversion says of a message; empty if it takes it.
std::string Refusal(const std::function<void()>& convert) {
  try {
    convert();
    return "";
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

template <typename Message, typename Change>
std::string RefusalOf(Message message, const Change& change) {
  change(&message);
  return Refusal([&] { FromMessage(message); });
}

ScanMatch GoodMatch() {
  ScanMatch match;
  match.header.stamp = match.start_stamp = match.reference_stamp = ros::Time(1000, 0);
  match.has_odometry = true;
  return match;
}

IcpModel GoodModel() {
  IcpModel model;
  model.header.stamp = ros::Time(1000, 0);
  model.bearings = model.time_offsets = model.edge_weights = {0.0f};
  model.ranges = model.points_x = model.points_y = {1.0f};
  model.edge_signs = {0};
  model.edges.resize(1);
  return model;
}

TEST(HostileMatch, IsRefused) {
  EXPECT_EQ(RefusalOf(GoodMatch(), [](ScanMatch*) {}), "");
  for (const double bad : {kNan, kInfinity, -1e300}) {
    EXPECT_NE(RefusalOf(GoodMatch(), [&](ScanMatch* m) { m->odom_pose.x = bad; }), "");
    EXPECT_NE(RefusalOf(GoodMatch(), [&](ScanMatch* m) { m->motion.y = bad; }), "");
    EXPECT_NE(RefusalOf(GoodMatch(), [&](ScanMatch* m) { m->reference_pose.x = bad; }), "");
  }
  EXPECT_NE(RefusalOf(GoodMatch(), [](ScanMatch* m) { m->motion.theta = kNan; }), "");
  EXPECT_NE(RefusalOf(GoodMatch(), [](ScanMatch* m) { m->covariance[4] = kNan; }), "");
  EXPECT_NE(RefusalOf(GoodMatch(), [](ScanMatch* m) { m->sweep_correction_yaw = kNan; }), "");
  EXPECT_NE(RefusalOf(GoodMatch(), [](ScanMatch* m) { m->edge_correction_x = kNan; }), "");
  EXPECT_NE(RefusalOf(GoodMatch(), [](ScanMatch* m) { m->edge_correction_y = 1e300; }), "");
  EXPECT_NE(RefusalOf(GoodMatch(), [](ScanMatch* m) { m->mode = 99; }), "");
  EXPECT_NE(RefusalOf(GoodMatch(), [](ScanMatch* m) { m->edge_uses = {2}; }), "");
  EXPECT_NE(RefusalOf(GoodMatch(),
                      [](ScanMatch* m) {
                        m->edge_uses = {4};
                        m->edge_residuals = {0.0f};
                      }),
            "");
}

TEST(HostileModel, IsRefused) {
  EXPECT_EQ(RefusalOf(GoodModel(), [](IcpModel*) {}), "");
  EXPECT_NE(RefusalOf(GoodModel(), [](IcpModel* m) { m->laser_x = kNan; }), "");
  EXPECT_NE(RefusalOf(GoodModel(), [](IcpModel* m) { m->laser_yaw = kInfinity; }), "");
  EXPECT_NE(RefusalOf(GoodModel(), [](IcpModel* m) { m->sweep_velocity_yaw = kNan; }), "");
  EXPECT_NE(RefusalOf(GoodModel(), [](IcpModel* m) { m->time_offsets[0] = 1.0f / 0.0f; }), "");
  EXPECT_NE(RefusalOf(GoodModel(), [](IcpModel* m) { m->time_offsets[0] = -1e20f; }), "");
  EXPECT_NE(RefusalOf(GoodModel(), [](IcpModel* m) { m->sweep_velocity_x = 1e300; }), "");
  EXPECT_NE(RefusalOf(GoodModel(), [](IcpModel* m) { m->points_y[0] = 1e30f; }), "");
  EXPECT_NE(RefusalOf(GoodModel(), [](IcpModel* m) { m->edges[0].weight = kNan; }), "");
  EXPECT_NE(RefusalOf(GoodModel(), [](IcpModel* m) { m->bearings.clear(); }), "");
  EXPECT_NE(RefusalOf(GoodModel(), [](IcpModel* m) { m->edges.resize(10001); }), "");
  EXPECT_NE(RefusalOf(GoodModel(),
                      [](IcpModel* m) {
                        for (auto* floats : {&m->bearings, &m->ranges, &m->time_offsets,
                                             &m->points_x, &m->points_y, &m->edge_weights}) {
                          floats->assign(100001, 1.0f);
                        }
                        m->edge_signs.assign(100001, 0);
                      }),
            "");
}

TEST(HostileStamp, WithTooManyNanosecondsIsRefused) {
  ros::Time time;
  time.sec = 4294967295U;
  time.nsec = 999999999U;
  EXPECT_EQ(ToRosTime(ToStamp(time)), time);  // the last one there is
  time.nsec = 1000000000U;
  EXPECT_THROW(ToStamp(time), std::invalid_argument);
}

TEST(HostileScan, ThatTakesForEverIsRefused) {
  sensor_msgs::LaserScan scan;
  scan.header.stamp = ros::Time(1000, 0);
  scan.angle_increment = 0.01f;
  scan.ranges.assign(100, 1.0f);
  scan.range_max = 30.0f;
  scan.time_increment = 0.5f;
  EXPECT_EQ(Refusal([&] { ToLaserScan(scan); }), "");
  scan.time_increment = -1e20f;
  EXPECT_NE(Refusal([&] { ToLaserScan(scan); }).find("time_increment"), std::string::npos);
}

TEST(HostileScan, WithTooManyBeamsIsRefused) {
  sensor_msgs::LaserScan scan;
  scan.header.stamp = ros::Time(1000, 0);
  scan.angle_increment = 1e-5f;
  scan.range_max = 30.0f;
  scan.ranges.assign(100000, 1.0f);
  EXPECT_EQ(Refusal([&] { ToLaserScan(scan); }), "");
  scan.ranges.push_back(1.0f);
  EXPECT_NE(Refusal([&] { ToLaserScan(scan); }).find("100001 beams"), std::string::npos);
}

TEST(HostileTransform, OutOfThisWorldIsRefused) {
  geometry_msgs::Transform transform;
  transform.rotation.w = 1.0;
  EXPECT_EQ(Refusal([&] { ToIsometry(transform); }), "");
  for (const double bad : {kNan, kInfinity, 1e300}) {
    geometry_msgs::Transform wrong = transform;
    wrong.translation.z = bad;
    EXPECT_NE(Refusal([&] { ToIsometry(wrong); }), "");
  }
  transform.rotation.w = 0.5;
  EXPECT_NE(Refusal([&] { ToIsometry(transform); }).find("quaternion"), std::string::npos);
}

TEST(HostileCalibration, WithAnImpossibleRegionIsRefused) {
  sensor_msgs::CameraInfo info;
  info.width = 640;
  info.height = 480;
  info.K = {500.0, 0.0, 320.0, 0.0, 500.0, 240.0, 0.0, 0.0, 1.0};
  info.distortion_model = "plumb_bob";
  info.D.assign(5, 0.0);
  EXPECT_EQ(Refusal([&] { ToCameraIntrinsics(info); }), "");
  info.roi.width = info.roi.height = 3000000000U;
  EXPECT_NE(Refusal([&] { ToCameraIntrinsics(info); }).find("3000000000"), std::string::npos);
}

TEST(HostilePose, OutOfThisWorldIsRefused) {
  geometry_msgs::Pose pose;
  pose.orientation.w = 1.0;
  pose.position.x = 5e6;  // as in geographic coordinates
  EXPECT_EQ(Refusal([&] { ToPose2(pose); }), "");
  for (const double bad : {kNan, kInfinity, 1e300}) {
    pose.position.y = bad;
    EXPECT_NE(Refusal([&] { ToPose2(pose); }), "");
  }
}

}  // namespace
}  // namespace scan_image_slam
