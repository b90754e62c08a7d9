#include "scan_image_slam/ros/slam_messages.h"

#include "support_same.h"

#include <gtest/gtest.h>

namespace scan_image_slam {
namespace {

/// Every number of its own, so that none can take another's place.
TEST(ScanMatch, ArrivesAsItWasSent) {
  MatchedMotion sent;
  sent.stamp = 3'000'000'001;
  sent.start_stamp = 1'000'000'002;
  sent.reference_stamp = 2'000'000'003;
  sent.start_from_reference = {1.0, 2.0, 0.3};
  sent.motion = {4.0, 5.0, 0.6};
  sent.covariance << 1, 2, 3, 4, 5, 6, 7, 8, 9;
  sent.mode = MatchMode::kNoEncoders;
  sent.status = MatchStatus::kDegenerate;
  sent.window = {0.1, 0.2, 0.3};
  sent.deviation = {0.4, 0.5, 0.6};
  sent.e = 0.7;
  sent.rms = 0.8;
  sent.candidates = 11;
  sent.points = 12;
  sent.matched = 13;
  sent.edges = {{EdgeUse::kNew, 0.25}, {EdgeUse::kMatched, 0.5}};
  sent.degenerate_direction = 0.9;
  sent.sweep_correction = {1.1, 1.2, 1.3};
  sent.edge_correction = {1.4, 1.5, 1.6};
  sent.odom_from_base = Pose2{7.0, 8.0, 0.9};

  const MatchedMotion got = FromMessage(ToMessage(sent, "base_link"));
  EXPECT_EQ(got.stamp, sent.stamp);
  EXPECT_EQ(got.start_stamp, sent.start_stamp);
  EXPECT_EQ(got.reference_stamp, sent.reference_stamp);
  ExpectSame(got.start_from_reference, sent.start_from_reference);
  ExpectSame(got.motion, sent.motion);
  EXPECT_EQ(got.covariance, sent.covariance);
  EXPECT_EQ(got.mode, sent.mode);
  EXPECT_EQ(got.status, sent.status);
  EXPECT_EQ(got.window.half_distance, sent.window.half_distance);
  EXPECT_EQ(got.window.half_lateral, sent.window.half_lateral);
  EXPECT_EQ(got.window.half_angle, sent.window.half_angle);
  EXPECT_EQ(got.deviation.distance, sent.deviation.distance);
  EXPECT_EQ(got.deviation.lateral, sent.deviation.lateral);
  EXPECT_EQ(got.deviation.angle, sent.deviation.angle);
  EXPECT_EQ(got.e, sent.e);
  EXPECT_EQ(got.rms, sent.rms);
  EXPECT_EQ(got.candidates, sent.candidates);
  EXPECT_EQ(got.points, sent.points);
  EXPECT_EQ(got.matched, sent.matched);
  ASSERT_EQ(got.edges.size(), sent.edges.size());
  for (std::size_t i = 0; i < sent.edges.size(); ++i) {
    EXPECT_EQ(got.edges[i].use, sent.edges[i].use);
    EXPECT_EQ(got.edges[i].residual, sent.edges[i].residual);
  }
  EXPECT_EQ(got.degenerate_direction, sent.degenerate_direction);
  ExpectSame(got.sweep_correction, sent.sweep_correction);
  ExpectSame(got.edge_correction, sent.edge_correction);
  ASSERT_TRUE(got.odom_from_base);
  ExpectSame(*got.odom_from_base, *sent.odom_from_base);
}

}  // namespace
}  // namespace scan_image_slam
