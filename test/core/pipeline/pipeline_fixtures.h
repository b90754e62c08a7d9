#pragma once

#include "core/geometry/pose_near.h"
#include "scan_image_slam/core/pipeline/slam_pipeline.h"
#include "support_rooms.h"

#include <cmath>
#include <vector>

namespace scan_image_slam {

/// Stamps of recordings: not near zero.
constexpr Stamp kRunStart = 1700000000LL * 1000000000LL;

/// A drive through a room, as its sensors see it: a laser at 10 Hz, encoders at 50 Hz that tell a
/// way too long and a turn too large.
struct TestDrive {
  Room room = FurnishedRoom();
  Pose2 start{-2.5, -0.5, 0.3};  ///< in the room
  Velocity2 velocity{0.4, 0.0, 0.15};
  TestLaser laser;
  double period = 0.1;  ///< of the scans; five readings of the encoders to each [s]
  double encoder_scale = 1.05;
  bool has_encoders = true;
  std::uint64_t seed = 5;

  TestDrive() {
    laser.beams = 360;
    laser.range_stddev = 0.01;
  }
  Pose2 PoseAt(double seconds) const { return start * Move(velocity, seconds); }
  /// The encoders begin at zero and slip evenly.
  Pose2 OdomAt(double seconds) const {
    return Move({encoder_scale * velocity.x, velocity.y, encoder_scale * velocity.theta}, seconds);
  }
  LaserScan ScanAt(double seconds, TestRandom* random) const {
    return ScanOf(room, PoseAt(seconds), kRunStart + FromSeconds(seconds), laser, random);
  }
};

/// Calls `feed(seconds, scan)` at each scan, after the encoders have reached it.
template <typename Feed>
void ForEachScan(const TestDrive& drive, int scans, SlamPipeline* pipeline, const Feed& feed) {
  TestRandom random(drive.seed);
  for (int i = 0; i < scans; ++i) {
    for (int k = i == 0 ? 0 : -4; drive.has_encoders && k <= 0; ++k) {
      const double seconds = drive.period * (i + 0.2 * k);
      const Stamp stamp = kRunStart + FromSeconds(seconds);
      pipeline->AddOdometry(stamp, drive.OdomAt(seconds), stamp);
    }
    feed(drive.period * i, drive.ScanAt(drive.period * i, &random));
  }
}

/// Collects what comes out of a pipeline.
struct PipelineRun {
  std::vector<PipelineResult> results;
  SlamPipeline pipeline;

  explicit PipelineRun(const SlamOptions& options = SlamOptions())
      : pipeline(options, [this](const PipelineResult& r) { results.push_back(r); }) {}
  PipelineRun(const PipelineRun&) = delete;
  PipelineRun& operator=(const PipelineRun&) = delete;

  void Add(const LaserScan& scan) { pipeline.AddScan(scan, scan.stamp); }
  void Drive(const TestDrive& drive, int scans) {
    ForEachScan(drive, scans, &pipeline, [&](double, const LaserScan& scan) { Add(scan); });
    pipeline.Finish();
  }
};

/// Distance and turn between where the robot is and where it is thought to be, both seen from the
/// first result.
struct PoseError {
  double distance = 0.0;  ///< [m]
  double angle = 0.0;     ///< [rad]
};
inline PoseError ErrorOf(const PipelineResult& result, const PipelineResult& first,
                         const TestDrive& drive) {
  const auto seconds = [](const PipelineResult& r) { return Seconds(r.pose.stamp - kRunStart); };
  const Pose2 truth = drive.PoseAt(seconds(first)).Inverse() * drive.PoseAt(seconds(result));
  const Pose2 estimate = first.pose.map_from_base.Inverse() * result.pose.map_from_base;
  return {(estimate.translation() - truth.translation()).norm(),
          std::abs(AngleBetween(truth.theta, estimate.theta))};
}

inline PoseError LargestError(const std::vector<PipelineResult>& results, const TestDrive& drive) {
  PoseError largest;
  for (const PipelineResult& result : results) {
    const PoseError error = ErrorOf(result, results.front(), drive);
    largest.distance = std::max(largest.distance, error.distance);
    largest.angle = std::max(largest.angle, error.angle);
  }
  return largest;
}

inline bool IsFinite(const PipelineResult& result) {
  const Pose2& p = result.pose.map_from_base;
  return IsFinite(p) && result.pose.covariance.allFinite();
}

}  // namespace scan_image_slam
