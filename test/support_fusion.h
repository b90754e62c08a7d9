#pragma once

#include "scan_image_slam/core/fusion/surface_profile.h"
#include "scan_image_slam/core/geometry/pose2.h"
#include "scan_image_slam/core/sensor/camera_model.h"
#include "scan_image_slam/core/sensor/laser_scan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

namespace scan_image_slam {

/// A small world, a camera and a laser for tests of the fusion: by plain geometry, without the code
/// under test.

constexpr double kDegree = M_PI / 180.0;

inline CameraIntrinsics PinholeCamera(int width = 320, int height = 240, double focal = 300.0) {
  CameraIntrinsics intrinsics;
  intrinsics.width = width;
  intrinsics.height = height;
  intrinsics.k = cv::Matx33d(focal, 0, 0.5 * (width - 1), 0, focal, 0.5 * (height - 1), 0, 0, 1);
  return intrinsics;
}

/// Where a camera is and looks: at zero angles along x, upright.
struct CameraView {
  Eigen::Vector3d centre{0, 0, 0};
  double yaw = 0.0;    ///< to the left [rad]
  double pitch = 0.0;  ///< down [rad]
  double roll = 0.0;   ///< about the axis of view, clockwise for who looks along it [rad]

  /// To the base, or to the world, from the optical frame (x right, y down, z forward).
  Eigen::Isometry3d FromOptical() const {
    Eigen::Matrix3d optical;
    optical << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = (Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                     Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
                     Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()))
                        .toRotationMatrix() *
                    optical;
    pose.translation() = centre;
    return pose;
  }
};

/// The picture of a pinhole camera: `shade(origin, direction)` is the grey level that a ray sees.
/// Each pixel is the mean over 5 x 5 rays.
template <typename Shade>
cv::Mat RenderPicture(const CameraIntrinsics& camera, const Eigen::Isometry3d& world_from_camera,
                      const Shade& shade) {
  constexpr int kRays = 5;
  cv::Mat picture(camera.height, camera.width, CV_8U);
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      double sum = 0.0;
      for (int i = 0; i < kRays * kRays; ++i) {
        const double x = u - 0.5 + (i % kRays + 0.5) / kRays;
        const double y = v - 0.5 + (i / kRays + 0.5) / kRays;
        const Eigen::Vector3d ray((x - camera.k(0, 2)) / camera.k(0, 0),
                                  (y - camera.k(1, 2)) / camera.k(1, 1), 1.0);
        const Eigen::Vector3d origin = world_from_camera.translation();
        sum += shade(origin, Eigen::Vector3d(world_from_camera.linear() * ray));
      }
      picture.at<std::uint8_t>(v, u) = static_cast<std::uint8_t>(sum / (kRays * kRays) + 0.5);
    }
  }
  return picture;
}

/// A stripe of paint on a wall.
struct Paint {
  double begin = 0.0;   ///< along the wall, from its `from` [m]
  double end = 0.0;     ///< [m]
  double bottom = 0.0;  ///< [m]
  double top = 0.0;     ///< [m]
  double grey = 60.0;
};

/// A straight wall, higher than any camera sees.
struct PaintedWall {
  Eigen::Vector2d from{0, 0};
  Eigen::Vector2d to{0, 0};
  double grey = 180.0;
  std::vector<Paint> paints;

  /// Where a ray in the plane meets the wall, as a multiple of `direction` and in metres from
  /// `from`; false if it does not.
  bool Meet(const Eigen::Vector2d& origin, const Eigen::Vector2d& direction, double* multiple,
            double* along) const {
    const Eigen::Vector2d way = to - from;
    const Eigen::Vector2d start = from - origin;
    const double cross = direction.x() * way.y() - direction.y() * way.x();
    if (std::abs(cross) < 1e-12) return false;
    *multiple = (start.x() * way.y() - start.y() * way.x()) / cross;
    *along = (start.x() * direction.y() - start.y() * direction.x()) / cross * way.norm();
    return *multiple > 0.0 && *along >= 0.0 && *along <= way.norm();
  }
};

struct PaintedWorld {
  std::vector<PaintedWall> walls;
  double floor_height = 0.0;
  double floor_grey = 120.0;
  double sky_grey = 120.0;

  PaintedWall& AddWall(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
    walls.emplace_back();
    walls.back().from = from;
    walls.back().to = to;
    return walls.back();
  }

  /// +Inf where there is no wall.
  double Range(const Eigen::Vector2d& origin, double heading) const {
    double nearest = std::numeric_limits<double>::infinity();
    const Eigen::Vector2d direction(std::cos(heading), std::sin(heading));
    double range = 0.0;
    double along = 0.0;
    for (const PaintedWall& wall : walls) {
      if (wall.Meet(origin, direction, &range, &along)) nearest = std::min(nearest, range);
    }
    return nearest;
  }

  double Grey(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const {
    double nearest = std::numeric_limits<double>::infinity();
    double grey = sky_grey;
    if (direction.z() < 0.0) {
      nearest = (floor_height - origin.z()) / direction.z();
      grey = floor_grey;
    }
    double multiple = 0.0;
    double along = 0.0;
    for (const PaintedWall& wall : walls) {
      if (!wall.Meet(origin.head<2>(), direction.head<2>(), &multiple, &along)) continue;
      if (multiple >= nearest) continue;
      nearest = multiple;
      const double z = origin.z() + multiple * direction.z();
      grey = wall.grey;
      for (const Paint& p : wall.paints) {
        if (p.begin <= along && along < p.end && p.bottom <= z && z < p.top) grey = p.grey;
      }
    }
    return grey;
  }

  cv::Mat Picture(const CameraIntrinsics& camera,
                  const Eigen::Isometry3d& world_from_camera) const {
    return RenderPicture(camera, world_from_camera,
                         [this](const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
                           return Grey(origin, direction);
                         });
  }

  /// What an ideal laser measures that stands still.
  LaserScan Scan(const Pose2& world_from_laser, double angle_min, double increment,
                 int beams) const {
    LaserScan scan;
    scan.angle_min = angle_min;
    scan.angle_increment = increment;
    scan.range_min = 0.1;
    scan.range_max = 30.0;
    for (int i = 0; i < beams; ++i) {
      const double heading = world_from_laser.theta + angle_min + i * increment;
      scan.ranges.push_back(
          static_cast<float>(Range({world_from_laser.x, world_from_laser.y}, heading)));
    }
    return scan;
  }
};

/// The base in the plane, as a motion in space.
inline Eigen::Isometry3d Lift(const Pose2& pose) {
  Eigen::Isometry3d lifted = Eigen::Isometry3d::Identity();
  lifted.linear() = Eigen::AngleAxisd(pose.theta, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  lifted.translation() = Eigen::Vector3d(pose.x, pose.y, 0.0);
  return lifted;
}

/// The profile of a model seen from where the laser is.
inline SurfaceProfile ProfileOf(const FusedModel& model, const BearingImage& image) {
  std::vector<Eigen::Vector2d> points;
  for (const ModelBeam& beam : model.beams) points.push_back(beam.point);
  return MakeSurfaceProfile(model, points, image);
}

}  // namespace scan_image_slam
