#pragma once

#include "scan_image_slam/core/calibration/calibration_view.h"
#include "support_rooms.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace scan_image_slam {

/// A drive between posts whose sides the laser and the camera see: by plain geometry, with all that
/// a calibration has to find out.
struct PostsDrive {
  double yaw = 0.0;      ///< true minus assumed [rad]
  double forward = 0.0;  ///< [m]
  double left = 0.0;     ///< [m]
  double time = 0.0;     ///< true times of the pictures minus their stamps [s]
  double tilt_x = 0.0;   ///< [rad]
  double tilt_y = 0.0;   ///< [rad]
  double border = 0.0;   ///< by which the laser makes each post wider [rad]

  double turn_rate = 0.5;         ///< amplitude; 0 drives straight on [rad/s]
  double seconds = 20.0;          ///< of the drive
  double nearest = 1.0;           ///< distance of the posts from the way [m]
  double farthest = 4.0;          ///< [m]
  double noise = 0.001;           ///< of a bearing, standard deviation [rad]
  int clutter = 8;                ///< other edges in each picture
  bool posts_in_pictures = true;  ///< false: clutter only
  std::uint64_t seed = 1;

  CalibrationData Record() const {
    TestRandom random(seed);
    CalibrationData data;
    data.camera = {0.1, 0.0};
    data.pixel = 0.0024;
    // Driven at 0.5 m/s, the heading swings; a pose for each millisecond.
    constexpr double kSwing = 0.8;  // [rad/s]
    std::vector<Pose2> poses;
    Pose2 pose;
    for (int ms = 0; ms <= static_cast<int>(1000.0 * seconds); ++ms) {
      pose.theta = turn_rate / kSwing * std::sin(kSwing * 1e-3 * ms);
      poses.push_back(pose);
      pose.x += 0.5e-3 * std::cos(pose.theta);
      pose.y += 0.5e-3 * std::sin(pose.theta);
    }
    struct Side {
      Eigen::Vector2d point;
      int side;
    };
    std::vector<Side> sides;
    for (double x = 0.0; x < 0.5 * seconds + 6.0; x += 0.4) {
      const double y = random.Uniform(nearest, farthest) * (random.Index(2) == 0 ? 1.0 : -1.0);
      sides.push_back({{x, y}, random.Index(2) == 0 ? 1 : -1});
    }
    for (std::size_t ms = 0; ms < poses.size(); ms += 25) {
      data.trajectory.push_back({FromSeconds(10.0 + 1e-3 * static_cast<double>(ms)), poses[ms]});
    }
    for (int ms = 200; ms + 200 < static_cast<int>(poses.size()); ms += 67) {
      CalibrationView view;
      view.stamp = FromSeconds(10.0 + 1e-3 * ms - time);
      const Pose2 base_from_world = poses[ms].Inverse();
      for (const Side& s : sides) {
        const Eigen::Vector2d p = base_from_world * s.point;
        const Eigen::Vector2d q = p - data.camera - Eigen::Vector2d(forward, left);
        const double bearing = std::atan2(q.y(), q.x());
        if (q.norm() > 5.0 || q.norm() < 0.3) continue;
        if (std::abs(bearing) < 0.65 && posts_in_pictures) {
          AddEdge(bearing + noise * random.Normal(), &random, &view);
        }
        const double laser = std::atan2(p.y(), p.x()) + s.side * border;
        view.jumps.push_back({FromSeconds(10.0 + 1e-3 * ms),
                              p.norm() * Eigen::Vector2d(std::cos(laser), std::sin(laser)), s.side,
                              0.0012});
      }
      for (int i = 0; i < clutter; ++i) AddEdge(random.Uniform(-0.65, 0.65), &random, &view);
      data.views.push_back(view);
    }
    return data;
  }

 private:
  /// As a camera with the assumed attitude takes an upright edge at a true bearing.
  void AddEdge(double bearing, TestRandom* random, CalibrationView* view) const {
    ViewedEdge edge;
    edge.slope = random->Uniform(-0.2, 0.1);
    edge.lean = tilt_x * std::cos(bearing) + tilt_y * std::sin(bearing);
    edge.lean_stddev = 0.002;
    edge.bearing = bearing - yaw + edge.slope * edge.lean;
    view->edges.push_back(edge);
  }
};

}  // namespace scan_image_slam
