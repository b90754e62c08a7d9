#pragma once

#include "scan_image_slam/core/geometry/covariance.h"
#include "scan_image_slam/core/mapping/loop_closer.h"
#include "support_rooms.h"

#include <memory>
#include <vector>

#include <gtest/gtest.h>

namespace scan_image_slam {

/// Keyframes of a drive through a room, whose motions are measured with a steady error.
struct DriftingDrive {
  std::vector<Pose2> truth;
  std::vector<std::shared_ptr<const Keyframe>> keyframes;
};

struct DriftPerKeyframe {
  double distance = 1.0;  ///< factor of the way [-]
  double angle = 0.0;     ///< added to each turn [rad]
};

/// Of each motion, by its own account: less than steady errors of it add up to.
inline Eigen::Matrix3d ClaimedOfAMotion() { return DiagonalCovariance(0.003, 0.001); }

inline Keyframe KeyframeAt(const Room& room, const Pose2& room_from_base, int id,
                           double max_range = 12.0) {
  TestLaser laser;
  laser.beams = 360;
  laser.max_range = max_range;
  MatchedMotion match;
  match.stamp = 1000 * (id + 1);
  Keyframe keyframe =
      MakeKeyframe(ModelOf(room, room_from_base, match.stamp, laser), match, KeyframeOptions());
  keyframe.id = id;
  return keyframe;
}

/// Drives along straight lines from corner to corner, a keyframe every 0.4 m; turns on the spot.
inline DriftingDrive Drive(const Room& room, const std::vector<Eigen::Vector2d>& corners,
                           const DriftPerKeyframe& drift, double max_range = 12.0) {
  constexpr double kStep = 0.4;
  DriftingDrive drive;
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    const Eigen::Vector2d way = corners[i + 1] - corners[i];
    const int steps = static_cast<int>(way.norm() / kStep);
    for (int k = 0; k < steps; ++k) {
      const Eigen::Vector2d place = corners[i] + way * k / steps;
      drive.truth.push_back({place.x(), place.y(), std::atan2(way.y(), way.x())});
    }
  }
  double driven = 0.0;
  for (std::size_t i = 0; i < drive.truth.size(); ++i) {
    auto keyframe = std::make_shared<Keyframe>(
        KeyframeAt(room, drive.truth[i], static_cast<int>(i), max_range));
    keyframe->previous_from_base = drive.truth[i];
    if (i > 0) {
      Pose2 motion = drive.truth[i - 1].Inverse() * drive.truth[i];
      driven += motion.translation().norm();
      motion.x *= drift.distance;
      motion.theta += drift.angle;
      keyframe->previous_from_base = motion;
    }
    keyframe->way = driven;
    keyframe->covariance = ClaimedOfAMotion();
    drive.keyframes.push_back(keyframe);
  }
  return drive;
}

/// Largest distance of an estimated pose from the true one [m].
inline double LargestError(const GraphPoses& poses, const std::vector<Pose2>& truth) {
  double largest = 0.0;
  for (const auto& [id, pose] : poses) {
    largest = std::max(largest, (pose.translation() - truth.at(id).translation()).norm());
  }
  return largest;
}

inline void ExpectSameBits(const GraphPoses& a, const GraphPoses& b) {
  ASSERT_EQ(a.size(), b.size());
  for (const auto& [id, pose] : a) {
    ASSERT_EQ(b.count(id), 1U);
    EXPECT_EQ(pose.coordinates(), b.at(id).coordinates()) << id;
  }
}

/// A corridor of 2 m around a block of 12 m x 6 m; boxes along the walls make places differ.
inline Room RingOfCorridors() {
  return Rectangle(-8, -5, 8, 5) + Rectangle(-6, -3, 6, 3) + Rectangle(-3.0, -5.0, -2.4, -4.7) +
         Rectangle(2.0, -5.0, 2.3, -4.6) + Rectangle(7.6, -1.0, 8.0, 0.5) +
         Rectangle(7.7, 2.0, 8.0, 2.3) + Rectangle(1.0, 4.6, 1.9, 5.0) +
         Rectangle(-4.5, 4.7, -4.1, 5.0) + Rectangle(-8.0, 1.0, -7.7, 2.2) +
         Rectangle(-8.0, -2.6, -7.6, -2.3);
}

inline std::vector<Eigen::Vector2d> AroundTheRing(int times) {
  std::vector<Eigen::Vector2d> corners = {{-4, -4}};
  for (int i = 0; i < times; ++i) {
    corners.insert(corners.end(), {{7, -4}, {7, 4}, {-7, 4}, {-7, -4}});
  }
  return corners;
}

inline std::vector<Eigen::Vector2d> TwiceAroundTheRing() { return AroundTheRing(2); }

}  // namespace scan_image_slam
